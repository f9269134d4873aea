//! The boundaries of a tile: lines in plan, read and written apart from the rest of the payload, as most readers do not want them.

#[cfg(feature = "write")]
mod encode;

use corniche_areas::BoundaryClass;
use corniche_geom::{LatticePoint, TileId};
use corniche_varints::zigzag;

use crate::limits::{MAX_BOUNDARIES, MAX_POINTS};
use crate::payload::damage::{Damage, DecodeError};
use crate::payload::envelope::{self, StoredSection};
use crate::payload::number_codes::{Cursor, Planes};
use crate::payload::section_kind::Kind;

#[cfg(feature = "write")]
pub use encode::{BoundariesSection, encode_boundaries, with_boundaries};

/// A part of a boundary near a tile: segments that follow each other, of which each comes into the tile or its level's margin around it. They
/// are not cut there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BoundaryRecord {
    /// OSM's id of the way.
    pub way_id: i64,
    /// The most important of what it bounds.
    pub class: BoundaryClass,
    /// At least two points; neighbours are different. They may lie outside of the tile.
    pub points: Vec<LatticePoint>,
}

/// Points are no farther than this from the lattice's origin, so that what is computed of them is exact.
const FARTHEST: i64 = 1 << 56;
/// No lattice of points is wider than this many steps.
const MOST_STEP: i64 = 1 << 40;

/// Reads the boundaries of a tile from the bytes of its payload; none if it has none. Memory is bounded by the
/// [`limits`](crate::limits), whatever the bytes say.
///
/// # Errors
/// When the bytes are not a payload of tile `id`, or the section is damaged.
pub fn decode_boundaries(bytes: &[u8], id: TileId) -> Result<Vec<BoundaryRecord>, DecodeError> {
    envelope::read_part(bytes, id, Kind::Boundaries.name(), decode_in)
}

/// The boundaries of these sections of a payload.
pub(crate) fn decode_in(sections: &[StoredSection<'_>]) -> Result<Vec<BoundaryRecord>, Damage> {
    let section = envelope::section(sections, Kind::Boundaries)?;
    Ok(section.map(|bytes| decode(&bytes)).transpose()?.unwrap_or_default())
}

/// Reads the section's bytes.
fn decode(bytes: &[u8]) -> Result<Vec<BoundaryRecord>, Damage> {
    let cursor = &mut Cursor::new(bytes);
    let step = i64::try_from(cursor.varint()?).ok().filter(|step| (1..=MOST_STEP).contains(step));
    let step = step.ok_or(Damage::Invalid { what: "the spacing of the boundaries' lattice" })?;
    let count = cursor.bounded(MAX_BOUNDARIES, "number of boundaries")?;
    let [classes, ways, lengths] =
        [cursor.planes(count)?, cursor.planes(count)?, cursor.planes(count)?];
    let points_count = total(lengths)?;
    let [east, north] = [cursor.planes(points_count)?, cursor.planes(points_count)?];
    cursor.finish()?;
    let mut east = Coordinates { steps: east.iter(), step, last: 0 };
    let mut north = Coordinates { steps: north.iter(), step, last: 0 };
    let mut way_id = 0_i64;
    let mut boundaries = Vec::with_capacity(count);
    for ((class, way), length) in classes.iter().zip(ways.iter()).zip(lengths.iter()) {
        let class = u8::try_from(class).ok().and_then(BoundaryClass::from_number);
        let class = class.ok_or(Damage::Invalid { what: "a class of boundaries" })?;
        way_id = way_id.wrapping_add(zigzag(way));
        let points: Result<Vec<LatticePoint>, Damage> =
            (0..length + 2).map(|_| Ok(LatticePoint::new(east.next()?, north.next()?))).collect();
        let points = points?;
        if points.array_windows().any(|[one, next]| one == next) {
            return Err(Damage::Invalid { what: "a boundary with a point twice" });
        }
        boundaries.push(BoundaryRecord { way_id, class, points });
    }
    Ok(boundaries)
}

/// The number of points, refused beyond the limit before anything is allocated for it.
fn total(lengths: Planes<'_>) -> Result<usize, Damage> {
    let (mut sum, limit) = (0_u64, MAX_POINTS as u64);
    for length in lengths.iter() {
        sum = sum.saturating_add(length).saturating_add(2);
        if sum > limit {
            return Err(Damage::TooLarge { what: "number of points", length: sum, limit });
        }
    }
    Ok(sum as usize)
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
        place.ok_or(Damage::Invalid { what: "a point far outside the tile" })
    }
}

#[cfg(test)]
#[path = "boundaries_tests.rs"]
mod tests;
