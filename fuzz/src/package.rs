//! Packages of any bytes are opened or rejected, and so are their tiles.

use std::sync::LazyLock;

use corniche_testing::{
    package::{manifest, metadata},
    pmtiles::{file, gzip},
};
use corniche_tileset::{MemorySource, OpenError, Package, Sections};

/// The number of tiles to read from each package: enough to find every kind of damage.
const TILES: usize = 32;
/// Stored metadata of the small package; with them, directories and tiles of any bytes can be read.
static METADATA: LazyLock<Vec<u8>> =
    LazyLock::new(|| gzip(metadata(&manifest()).to_string().as_bytes()));

/// Opens or rejects these bytes as a package, lists or rejects its tiles, and reads or rejects
/// every tile.
///
/// # Panics
/// When a reader breaks a promise.
pub fn package(data: &[u8]) {
    let Some(bytes) = package_of(data) else { return };
    let package = match pollster::block_on(Package::open(MemorySource::new(bytes))) {
        Ok(package) => package,
        Err(error) => {
            // Otherwise this target would test nothing after the manifest, and nobody would notice.
            let is_refused = data[0] % 4 == 2 && matches!(error, OpenError::Manifest { .. });
            assert!(!is_refused, "the small package's own manifest is rejected: {error}");
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
    assert!(
        ids.iter().all(|id| id.z() <= manifest.frame.max_level()),
        "a tile below the finest level"
    );
    for &id in ids.iter().take(TILES) {
        match pollster::block_on(package.payload(id, Sections::ALL)) {
            Ok(tile) => assert_eq!(tile.map(|tile| tile.id), Some(id), "a listed tile exists"),
            Err(error) => assert!(error.to_string().contains(&id.to_string()), "{error}"),
        }
    }
}

/// Converts these bytes to a file.
///
/// The first byte modulo 4 selects the content. 0: a file. 1: metadata before compression. 2: the
/// lengths (u16) of a root directory and of a leaf directory, both before compression, then the
/// tiles. 3, as for a first byte of `{`: all bytes are metadata before compression. `None` if there
/// are too few bytes.
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
        // There are no tiles: a root directory of 0 entries.
        1 => file([&gzip(&[0]), &gzip(rest), &[], &[]], 0),
        _ => file([&gzip(&[0]), &gzip(data), &[], &[]], 0),
    })
}
