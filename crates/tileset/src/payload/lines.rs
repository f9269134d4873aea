//! The lines of a tile with a class each, such as boundaries: lines in plan, read and written apart from the rest of the payload, as most readers do not want them.

#[cfg(feature = "write")]
mod encode;

use corniche_areas::{ClassedLayer, LineClass, line_text};
use corniche_geom::{LatticePoint, TileId};
use corniche_varints::zigzag;

use crate::limits::{MAX_CLASSED_LINES, MAX_POINTS};
use crate::payload::damage::{Damage, DecodeError};
use crate::payload::envelope::{self, StoredSection};
use crate::payload::number_codes::Cursor;
use crate::payload::section_kind::Kind;

#[cfg(feature = "write")]
pub use encode::encode_lines;

/// A part of a way of a layer of lines near a tile: segments that follow each other, of which each comes into the tile or its level's margin around it. They
/// are not cut there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LineRecord {
    /// OSM's id of the way.
    pub way_id: i64,
    /// The most important of its classes.
    pub class: LineClass,
    /// At least two points; neighbours are different. They may lie outside of the tile.
    pub points: Vec<LatticePoint>,
}

/// Points are no farther than this from the lattice's origin, so that what is computed of them is exact.
const FARTHEST: i64 = 1 << 56;
/// No lattice of points is wider than this many steps.
const MOST_STEP: i64 = 1 << 40;

/// Reads the lines of a layer of a tile from the bytes of its payload; none if it has none. Memory is bounded by the
/// [`limits`](crate::limits), whatever the bytes say.
///
/// # Errors
/// When the bytes are not a payload of tile `id`, or the section is damaged.
pub fn decode_lines(
    bytes: &[u8],
    id: TileId,
    layer: ClassedLayer,
) -> Result<Vec<LineRecord>, DecodeError> {
    let part = Kind::of_lines(layer).name();
    envelope::read_part(bytes, id, part, |sections| decode_in(sections, layer))
}

/// The lines of a layer of these sections of a payload.
pub(crate) fn decode_in(
    sections: &[StoredSection<'_>],
    layer: ClassedLayer,
) -> Result<Vec<LineRecord>, Damage> {
    let section = envelope::section(sections, Kind::of_lines(layer))?;
    Ok(section.map(|bytes| decode(&bytes, layer)).transpose()?.unwrap_or_default())
}

/// Reads the section's bytes.
fn decode(bytes: &[u8], layer: ClassedLayer) -> Result<Vec<LineRecord>, Damage> {
    let invalid = |what| Damage::Invalid(what);
    let cursor = &mut Cursor::new(bytes);
    let step = i64::try_from(cursor.varint()?).ok().filter(|step| (1..=MOST_STEP).contains(step));
    let step = step.ok_or(invalid(line_text!(layer, "the spacing of the " many "' lattice")))?;
    let count = cursor.bounded(MAX_CLASSED_LINES, line_text!(layer, "number of " many))?;
    let [classes, ways, lengths] =
        [cursor.planes(count)?, cursor.planes(count)?, cursor.planes(count)?];
    let points_count = lengths.total(2, MAX_POINTS, "number of points")?;
    let [east, north] = [cursor.planes(points_count)?, cursor.planes(points_count)?];
    cursor.finish()?;
    let mut east = Coordinates { steps: east.iter(), step, last: 0 };
    let mut north = Coordinates { steps: north.iter(), step, last: 0 };
    let mut way_id = 0_i64;
    let mut lines = Vec::with_capacity(count);
    for ((class, way), length) in classes.iter().zip(ways.iter()).zip(lengths.iter()) {
        let class = u8::try_from(class).ok().and_then(|number| layer.class(number));
        let class = class.ok_or(invalid(line_text!(layer, "a class of " many)))?;
        way_id = way_id.wrapping_add(zigzag(way));
        let points: Result<Vec<LatticePoint>, Damage> =
            (0..length + 2).map(|_| Ok(LatticePoint::new(east.next()?, north.next()?))).collect();
        let points = points?;
        if points.array_windows().any(|[one, next]| one == next) {
            return Err(invalid(line_text!(layer, "a " one " with a point twice")));
        }
        lines.push(LineRecord { way_id, class, points });
    }
    Ok(lines)
}

/// Coordinates along an axis, each as the difference to the one before.
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
