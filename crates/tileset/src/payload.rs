//! A tile's payload: its content and its bytes.

mod section_kind;
mod tile_payload;

#[cfg(feature = "write")]
mod builder;
mod decode;
#[cfg(feature = "write")]
mod encode;
mod of_package;
mod sizes;
mod summary;

mod context;
mod envelope;

mod attributes;
mod layers;
mod photo;
mod relief;
mod road_tags;
mod roads_geo;
mod roads_sv;
mod spans;
mod terrain;

mod class_table;
mod coded_lines;
mod connectivity;
mod corner_guess;
mod magnitudes;
mod near_corners;
mod number_codes;
mod point_models;
mod points;
mod range_coder;
mod route_guess;
mod source_grid;
mod turned_steps;
mod work_limit;

mod damage;

#[cfg(feature = "write")]
pub use builder::{EncodedTile, PayloadBuilder, Section};
pub use damage::{Damage, DecodeError, EncodeError};
pub use decode::decode;
#[cfg(feature = "write")]
pub use encode::{PayloadContext, encode, encode_sections};
pub use envelope::SectionSize;
#[cfg(feature = "write")]
pub use layers::encode_layer;
pub use layers::{AreaPolygon, LayerCoding, LayerObject, LayerShape, decode_layer};
pub use photo::{PHOTO_BORDER, Photo, decode_photo};
#[cfg(feature = "write")]
pub use photo::{encode_photo, photo_section};
pub use relief::Relief;
pub use section_kind::Sections;
pub use sizes::{PayloadSizes, payload_sizes};
#[cfg(feature = "write")]
pub use spans::encode_spans;
pub use spans::{RunOwner, SpanHeight, SpanPoint, SpanRun, decode_spans};
pub use summary::terrain_summary;
pub use tile_payload::{GeoRoad, RoadRecord, SvRoad, TerrainSummary, TilePayload, TileTerrain};

#[cfg(test)]
#[path = "payload_tests.rs"]
mod tests;
