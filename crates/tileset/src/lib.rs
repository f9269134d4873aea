//! Tile payloads and packages: values to bytes and back.
//!
//! This crate never computes geometry. Its reading side has no C dependency and builds for wasm32.

mod manifest;
mod payload;

pub use manifest::{
    Counts, GrowthRow, InputRecord, LevelRecord, Manifest, RoadLoss, SampleCounts, SettingsRecord, VerticalRecord,
};
#[cfg(feature = "write")]
pub use payload::{EncodedTile, PayloadContext, encode};
pub use payload::{
    Damage, DecodeError, EncodeError, GeoRoad, MAX_SECTION_BYTES, RoadRecord, SectionSize, Sections, SvRoad, Terrain,
    TilePayload, decode,
};
