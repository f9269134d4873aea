//! The areas of a tile: parts of water, forest and so on that lie in it, read and written apart from the rest of the payload, as most
//! readers do not want them.

mod decode;
#[cfg(feature = "write")]
mod encode;
mod record;

use corniche_geom::{Frame, TileId};

use crate::payload::damage::DecodeError;
use crate::payload::envelope;
use crate::payload::section_kind::Kind;

pub(crate) use decode::decode;
#[cfg(feature = "write")]
pub use encode::{AreasSection, area_part_sizes, encode_areas, with_areas};
pub use record::{AreaRecord, AreaRings};

/// Reads the areas of a tile from the bytes of its payload; none if it has none. Memory is bounded by the
/// [`limits`](crate::limits), whatever the bytes say.
///
/// # Errors
/// When the bytes are not a payload of tile `id`, or the section is damaged.
pub fn decode_areas(
    bytes: &[u8],
    id: TileId,
    frame: &Frame,
) -> Result<Vec<AreaRecord>, DecodeError> {
    let failed = |part| move |damage| DecodeError { tile: id, part, damage };
    let sections = envelope::open(bytes, id).map_err(failed("header"))?;
    let inside = failed(Kind::Areas.name());
    let section = envelope::section(&sections, Kind::Areas).map_err(inside)?;
    let bounds = frame.tile_lattice_bounds(id);
    let areas = section.map(|section| decode(&section, bounds)).transpose();
    Ok(areas.map_err(inside)?.unwrap_or_default())
}

#[cfg(test)]
#[path = "areas_tests.rs"]
mod tests;
