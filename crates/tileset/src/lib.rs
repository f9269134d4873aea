//! Tile payloads and packages: encodes values as bytes and decodes them.
//!
//! ```text
//!   TilePayload ── encode ──► bytes ── Writer ──► package.pmtiles ── Package ──► bytes ── decode ──► TilePayload
//!                  (feature "write")                                  (always; no C dependency, also wasm32)
//! ```
//!
//! `FORMAT.md` in this crate's folder specifies every byte.
//!
//! This crate never computes geometry: its guesses of triangles, heights and roads only serve
//! compression, and a wrong guess costs bytes but changes no value. The reading part has no C
//! dependency and builds for wasm32.
//!
//! The following example lists a package's tiles with their triangles and roads.
//! (`examples/read_package.rs` also prints positions and heights.)
//!
//! ```no_run
//! use std::path::Path;
//!
//! use corniche_tileset::{FilePackage, Sections};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let package = FilePackage::open(Path::new("out.pmtiles"))?;
//! for id in package.tile_ids()? {
//!     let Some(tile) = package.payload(id, Sections::ALL)? else { continue };
//!     let triangles = tile.terrain.map_or(0, |terrain| terrain.tin.triangles().len());
//!     println!("{id}: {triangles} triangles, {} roads", tile.roads_geo.len());
//! }
//! # Ok(())
//! # }
//! ```

mod layer_slot;
pub mod limits;
mod manifest;
mod package;
mod payload;
mod tile_order;

pub use layer_slot::LayerSlot;
pub use manifest::{
    ClipRecord, CreditError, DatumOperationRecord, Distribution, GrowthRow, InputKind, InputRecord,
    LayerClassRecord, LayerCounts, LayerRecord, LayerTableRecord, LeftOutRecord, LevelRecord,
    Manifest, ManifestCounts, OuterGround, PhotoLevelRecord, PhotoRecord, PolygonRecord,
    ReliefLevels, RoadLoss, SampleCounts, SampleErrorRecord, SampleSums, ScaleRecord,
    SectionLevelRecord, SettingsRecord, SpanCounts, SpansRecord, SvTail, SvTails, VerticalRecord,
    check_credit, to_credit,
};
#[cfg(not(target_arch = "wasm32"))]
pub use package::{AnySource, BlockingSource, FilePackage, FileSource};
pub use package::{
    ByteSource, FORMAT_VERSION, MemorySource, OpenError, Package, ReadError, SourceError,
    ToolRecord, telling_ranges,
};
#[cfg(feature = "write")]
pub use package::{PackageWriter, WriteError};
pub use payload::{
    AreaPolygon, Damage, DecodeError, EncodeError, GeoRoad, LayerCoding, LayerObject, LayerShape,
    PHOTO_BORDER, PayloadSizes, Photo, Relief, RoadRecord, RunOwner, SectionSize, Sections,
    SpanHeight, SpanPoint, SpanRun, SvRoad, TerrainSummary, TilePayload, TileTerrain, decode,
    decode_layer, decode_photo, decode_spans, payload_sizes, terrain_summary,
};
#[cfg(feature = "write")]
pub use payload::{
    EncodedTile, PayloadBuilder, PayloadContext, Section, encode, encode_layer, encode_photo,
    encode_sections, encode_spans, photo_section,
};
pub use tile_order::{pmtiles_order, tile_of_order};
