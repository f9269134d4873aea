use std::{io::Write, sync::OnceLock};

use corniche_tileset::{MemorySource, OpenError, Package, Sections};
use flate2::{Compression, write::GzEncoder};

/// Tiles read of each package: enough to reach every kind of damage.
const TILES: usize = 32;
const HEADER_BYTES: usize = 127;
/// Metadata of a small package, for directories and tiles to be looked at.
const METADATA: &[u8] = include_bytes!("../corpus/package/metadata.json");
/// The same as it is stored.
static STORED: OnceLock<Vec<u8>> = OnceLock::new();

/// A package of these bytes is opened or refused, its tiles listed or refused, every tile read or refused.
///
/// First byte modulo 4: 0 a file follows; 1 metadata follow, before compression; 2 lengths (u16) of a root directory
/// and of a leaf follow, then both before compression, then the tiles. 3, and a first byte of `{`: metadata.
///
/// # Panics
/// When a promise is broken.
pub fn package(data: &[u8]) {
    let Some((&first, rest)) = data.split_first() else { return };
    let bytes = match first % 4 {
        0 => rest.to_vec(),
        2 => {
            let Some((lengths, rest)) = rest.split_first_chunk::<4>() else { return };
            let length =
                |at: usize| usize::from(u16::from_le_bytes([lengths[at], lengths[at + 1]]));
            let (root, rest) = rest.split_at(length(0).min(rest.len()));
            let (leaf, tiles) = rest.split_at(length(2).min(rest.len()));
            file(&gzip(root), STORED.get_or_init(|| gzip(METADATA)), &gzip(leaf), tiles)
        }
        // No tiles: 0 entries.
        1 => file(&gzip(&[0]), &gzip(rest), &[], &[]),
        _ => file(&gzip(&[0]), &gzip(data), &[], &[]),
    };
    let package = match pollster::block_on(Package::open(MemorySource::new(bytes))) {
        Ok(package) => package,
        Err(error) => {
            // Else this target would look at nothing behind the manifest, in silence.
            let is_stale = first % 4 == 2 && matches!(error, OpenError::Manifest { .. });
            assert!(!is_stale, "corpus/package/metadata.json is out of date: {error}");
            return;
        }
    };
    let manifest = package.manifest();
    assert_eq!(manifest.levels.len(), usize::from(manifest.frame.max_level()) + 1);
    let sum: u64 = manifest.growth.iter().map(|row| row.source_bytes).sum();
    let position = manifest.frame.tile_bounds(corniche_geom::TileId::ROOT).center();
    let degrees = manifest.coordinates.wgs84_from_working(position);
    assert!(
        sum < u64::MAX && position.iter().all(|metres| metres.is_finite()) && degrees.len() == 2
    );
    let ids = pollster::block_on(package.tile_ids()).unwrap_or_default();
    assert!(ids.iter().all(|id| id.z() <= manifest.frame.max_level()), "a tile beyond the levels");
    for &id in ids.iter().take(TILES) {
        match pollster::block_on(package.payload(id, Sections::ALL)) {
            Ok(tile) => assert_eq!(tile.map(|tile| tile.id), Some(id), "listed, so it is there"),
            Err(error) => assert!(error.to_string().contains(&id.to_string()), "{error}"),
        }
    }
}

/// A PMTiles file of these parts, as the specification has it.
fn file(root: &[u8], metadata: &[u8], leaf: &[u8], tiles: &[u8]) -> Vec<u8> {
    let mut header = b"PMTiles\x03".to_vec();
    let mut offset = HEADER_BYTES;
    for part in [root, metadata, leaf, tiles] {
        header.extend((offset as u64).to_le_bytes());
        header.extend((part.len() as u64).to_le_bytes());
        offset += part.len();
    }
    // No counts; clustered, gzip, no compression of tiles, "other".
    header.extend([0; 24]);
    header.extend([1, 2, 1, 0]);
    header.resize(HEADER_BYTES, 0);
    [&header, root, metadata, leaf, tiles].concat()
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    // Writing to memory does not fail.
    if encoder.write_all(bytes).is_err() {
        return Vec::new();
    }
    encoder.finish().unwrap_or_default()
}
