//! Packages of any bytes are opened or refused, and so are their tiles.

use std::sync::LazyLock;

use corniche_testing::{
    package::{manifest, metadata},
    pmtiles::{file, gzip},
};
use corniche_tileset::{MemorySource, OpenError, Package, Sections};

/// Tiles read of each package: enough to reach every kind of damage.
const TILES: usize = 32;
/// Metadata of the small package as they are stored; with them, directories and tiles of any bytes can be read.
static METADATA: LazyLock<Vec<u8>> =
    LazyLock::new(|| gzip(metadata(&manifest()).to_string().as_bytes()));

/// A package of these bytes is opened or refused, its tiles listed or refused, every tile read or refused.
///
/// # Panics
/// When a promise is broken.
pub fn package(data: &[u8]) {
    let Some(bytes) = package_of(data) else { return };
    let package = match pollster::block_on(Package::open(MemorySource::new(bytes))) {
        Ok(package) => package,
        Err(error) => {
            // Otherwise this target would look at nothing behind the manifest, and nobody would notice.
            let is_refused = data[0] % 4 == 2 && matches!(error, OpenError::Manifest { .. });
            assert!(!is_refused, "the small package's own manifest is refused: {error}");
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

/// The file that these bytes stand for.
///
/// The first byte modulo 4 says what follows. 0: a file. 1: metadata before compression. 2: the lengths (u16) of a root
/// directory and of a leaf directory, both before compression, then the tiles. 3, as for a first byte of `{`: all bytes
/// are metadata before compression. `None` if there are too few bytes.
#[must_use]
pub fn package_of(data: &[u8]) -> Option<Vec<u8>> {
    let (&first, rest) = data.split_first()?;
    Some(match first % 4 {
        0 => rest.to_vec(),
        2 => {
            let (lengths, rest) = rest.split_first_chunk::<4>()?;
            let length =
                |at: usize| usize::from(u16::from_le_bytes([lengths[at], lengths[at + 1]]));
            let (root, rest) = rest.split_at(length(0).min(rest.len()));
            let (leaf, tiles) = rest.split_at(length(2).min(rest.len()));
            file([&gzip(root), &METADATA, &gzip(leaf), tiles], 0)
        }
        // No tiles: a root directory of 0 entries.
        1 => file([&gzip(&[0]), &gzip(rest), &[], &[]], 0),
        _ => file([&gzip(&[0]), &gzip(data), &[], &[]], 0),
    })
}
