//! The boundaries of a tile: lines in plan. They are read and written separately from the rest of
//! the payload, because most readers do not need them.

#[cfg(feature = "write")]
mod encode;

use corniche_areas::BoundaryClass;
use corniche_geom::{LatticePoint, TileId};
use corniche_varints::zigzag;

use crate::limits::{MAX_CLASSED_LINES, MAX_POINTS};
use crate::payload::damage::{Damage, DecodeError};
use crate::payload::envelope::{self, StoredSection};
use crate::payload::number_codes::Cursor;
use crate::payload::section_kind::SectionKind;

#[cfg(feature = "write")]
pub use encode::encode_boundaries;

/// A part of a way of a boundary near a tile: successive segments, each of which enters the tile or
/// the margin of its level around it. Segments are not cut at the border.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LineRecord {
    /// OSM's id of the way.
    pub way_id: i64,
    /// The most important class of the way.
    pub class: BoundaryClass,
    /// At least two points; neighbouring points are different. They may be outside the tile.
    pub points: Vec<LatticePoint>,
}

/// Points are at most this far from the lattice's origin, so that computations with them are exact.
const FARTHEST: i64 = 1 << 56;

/// Reads the boundaries of a tile from the bytes of its payload; empty if it has none. Memory stays
/// within the [`limits`](crate::limits), whatever the bytes say.
///
/// # Errors
/// When the bytes are not a payload of tile `id`, or the section is damaged.
pub fn decode_boundaries(bytes: &[u8], id: TileId) -> Result<Vec<LineRecord>, DecodeError> {
    envelope::read_part(bytes, id, SectionKind::Boundaries, decode_in)
}

/// Reads the boundaries from the sections of a payload.
pub(crate) fn decode_in(sections: &[StoredSection<'_>]) -> Result<Vec<LineRecord>, Damage> {
    let section = envelope::section(sections, SectionKind::Boundaries)?;
    Ok(section.map(|bytes| decode(&bytes)).transpose()?.unwrap_or_default())
}

/// Decodes the section's bytes.
fn decode(bytes: &[u8]) -> Result<Vec<LineRecord>, Damage> {
    let invalid = |what| Damage::Invalid(what);
    let cursor = &mut Cursor::new(bytes);
    let step = cursor.spacing("the spacing of the boundaries' lattice")?;
    let count = cursor.bounded(MAX_CLASSED_LINES, "number of boundaries")?;
    let [classes, ways, lengths] = cursor.columns(count)?;
    let points_count = lengths.total(2, MAX_POINTS, "number of points")?;
    let [east, north] = cursor.columns(points_count)?;
    cursor.finish()?;
    let mut east = Coordinates { steps: east.iter(), step, last: 0 };
    let mut north = Coordinates { steps: north.iter(), step, last: 0 };
    let mut way_id = 0_i64;
    let mut lines = Vec::with_capacity(count);
    for ((class, way), length) in classes.iter().zip(ways.iter()).zip(lengths.iter()) {
        let class = u8::try_from(class).ok().and_then(BoundaryClass::from_number);
        let class = class.ok_or(invalid("a class of boundaries"))?;
        way_id = way_id.wrapping_add(zigzag(way));
        let points: Result<Vec<LatticePoint>, Damage> =
            (0..length + 2).map(|_| Ok(LatticePoint::new(east.next()?, north.next()?))).collect();
        let points = points?;
        if points.array_windows().any(|[one, next]| one == next) {
            return Err(invalid("a boundary with two equal points in succession"));
        }
        lines.push(LineRecord { way_id, class, points });
    }
    Ok(lines)
}

/// Decodes coordinates along an axis, each as the difference from the coordinate before.
struct Coordinates<S> {
    steps: S,
    step: i64,
    last: i64,
}

impl<S: Iterator<Item = u64>> Coordinates<S> {
    fn next(&mut self) -> Result<i64, Damage> {
        let by = zigzag(self.steps.next().unwrap_or_default());
        let place = self.last.checked_add(by).and_then(|last| last.checked_mul(self.step));
        let place = place.filter(|place| (-FARTHEST..=FARTHEST).contains(place));
        self.last = place.map_or(0, |place| place / self.step);
        place.ok_or(Damage::Invalid("a point far outside the tile"))
    }
}

#[cfg(test)]
#[path = "lines_tests.rs"]
mod tests;
