//! Packages: PMTiles files of payloads with a manifest.

mod directory;
#[cfg(not(target_arch = "wasm32"))]
mod file_package;
mod header;
mod reader;
mod source;
mod tool_record;
#[cfg(feature = "write")]
mod writer;

use corniche_geom::TileId;
use serde::{Deserialize, Serialize};

#[cfg(not(target_arch = "wasm32"))]
pub use file_package::FilePackage;
pub use reader::{OpenError, Package, ReadError};
#[cfg(not(target_arch = "wasm32"))]
pub use source::FileSource;
pub use source::{ByteSource, MemorySource, SourceError};
pub use tool_record::ToolRecord;
#[cfg(feature = "write")]
pub use writer::{WriteError, Writer};

/// Version of a package's encodings, in [`Manifest::format_version`](crate::Manifest::format_version). Readers
/// refuse any other.
pub const FORMAT_VERSION: u32 = 0;

/// The JSON metadata of the file: what PMTiles tools show, and the manifest under a key of its own.
#[derive(Serialize, Deserialize)]
struct Metadata<M> {
    #[serde(default)]
    name: String,
    #[serde(default)]
    description: String,
    /// All credits in one line, as the PMTiles specification has it.
    #[serde(default)]
    attribution: String,
    corniche: M,
}

impl<'a> Metadata<&'a crate::Manifest> {
    /// What goes with a manifest.
    fn of(manifest: &'a crate::Manifest) -> Self {
        Self {
            name: "Corniche package".to_owned(),
            description: format!(
                "Terrain and roads by {}; z/x/y is a local quadtree in {}",
                manifest.generator, manifest.crs
            ),
            attribution: manifest.attribution.join(", "),
            corniche: manifest,
        }
    }
}

/// Place of a tile in a package: PMTiles' tile id, which counts tiles level by level along a Hilbert curve.
///
/// Source: PMTiles version 3 specification, section 4.1.
#[must_use]
pub fn pmtiles_order(id: TileId) -> u64 {
    // A tile id is valid from construction, and PMTiles knows more levels than we do.
    pmtiles::TileCoord::new(id.z(), id.x(), id.y())
        .map_or(u64::MAX, |coord| pmtiles::TileId::from(coord).value())
}

/// The tile at a place; `None` for places beyond the deepest level.
fn tile_at(order: u64) -> Option<TileId> {
    let coord = pmtiles::TileCoord::from(pmtiles::TileId::new(order).ok()?);
    TileId::new(coord.z(), coord.x(), coord.y()).ok()
}
