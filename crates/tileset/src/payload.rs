//! A tile's payload: what it holds, and its bytes.

mod section_kind;
mod tile_payload;

mod decode;
#[cfg(feature = "write")]
mod encode;
mod sizes;
mod summary;

mod context;
mod envelope;

mod areas;
mod attributes;
mod lines;
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
mod points;
mod range_coder;
mod route_guess;
mod source_grid;
mod turned_steps;
mod work_limit;

mod damage;

pub use areas::{AreaRecord, AreaRings, decode_areas};
#[cfg(feature = "write")]
pub use areas::{AreasSection, encode_areas, with_areas};
pub use damage::{Damage, DecodeError, EncodeError};
pub use decode::decode;
#[cfg(feature = "write")]
pub use encode::{EncodedTile, PayloadContext, encode, encode_with_ground_of};
pub use envelope::SectionSize;
pub use lines::{LineRecord, decode_lines};
#[cfg(feature = "write")]
pub use lines::{LinesSection, encode_lines, with_lines};
pub use photo::{PHOTO_BORDER, Photo, decode_photo};
#[cfg(feature = "write")]
pub use photo::{PhotoSection, encode_photo, photo_section, with_photo};
pub use relief::Relief;
pub use section_kind::Sections;
pub use sizes::{PayloadSizes, payload_sizes};
pub use spans::{SpanHeight, SpanPoint, SpanRun, decode_spans};
#[cfg(feature = "write")]
pub use spans::{SpansSection, encode_spans, with_spans};
pub use summary::terrain_summary;
pub use tile_payload::{GeoRoad, RoadRecord, SvRoad, Terrain, TerrainSummary, TilePayload};

#[cfg(test)]
#[path = "payload_tests.rs"]
mod tests;
