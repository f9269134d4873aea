//! The areas of a tile: the parts of water, forest and other areas that are in it. They are read
//! and written separately from the rest of the payload, because most readers do not need them.

mod coded_rings;
mod decode;
#[cfg(feature = "write")]
mod encode;
mod record;

use corniche_geom::{GridFrame, LatticeBounds, TileId};

use crate::payload::damage::{Damage, DecodeError};
use crate::payload::envelope::{self, StoredSection};
use crate::payload::section_kind::{AREAS, SectionKind};

use decode::decode;
#[cfg(feature = "write")]
pub use encode::encode_areas;
pub use record::{AreaRecord, AreaRings};

/// Reads the areas of a tile from the bytes of its payload; empty if it has none. Memory stays
/// within the [`limits`](crate::limits), whatever the bytes say.
///
/// # Errors
/// When the bytes are not a payload of tile `id`, or the section is damaged.
pub fn decode_areas(
    bytes: &[u8],
    id: TileId,
    frame: &GridFrame,
) -> Result<Vec<AreaRecord>, DecodeError> {
    let bounds = frame.tile_lattice_bounds(id);
    envelope::read_part(bytes, id, SectionKind::Areas, |sections| decode_in(sections, bounds))
}

/// Reads the areas from the sections of a payload.
pub(crate) fn decode_in(
    sections: &[StoredSection<'_>],
    bounds: LatticeBounds,
) -> Result<Vec<AreaRecord>, Damage> {
    let section = envelope::section_of_two(sections, AREAS)?;
    let areas = section.map(|(bytes, is_coded)| decode(&bytes, is_coded, bounds)).transpose()?;
    Ok(areas.unwrap_or_default())
}

#[cfg(test)]
#[path = "areas_tests.rs"]
mod tests;
