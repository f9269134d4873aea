//! The spans of a tile: stretches of bridges and tunnels that are off the ground. They are read and
//! written separately from the rest of the payload.

#[cfg(feature = "write")]
mod encode;
mod span_run;

use std::iter;

use corniche_geom::{GridFrame, LatticePoint, TileId};
use corniche_roads::Structure;
use corniche_varints::zigzag;

use crate::{
    limits::{MAX_LINES, MAX_SPAN_POINTS},
    payload::{
        context::CodingContext,
        damage::{Damage, DecodeError, Result},
        envelope,
        number_codes::{Cursor, take_room},
        points::decode_points,
        section_kind::SectionKind,
        terrain,
    },
};

#[cfg(feature = "write")]
pub use encode::encode_spans;
pub use span_run::{RunOwner, SpanHeight, SpanPoint, SpanRun};

/// The flag bits of a run's first number.
const FIRST_ON_GROUND: u64 = 1;
const LAST_ON_GROUND: u64 = 2;
const TUNNEL: u64 = 4;
/// The number of the owner begins at this bit.
const OWNER_BIT: u32 = 3;

/// Bridges need ground beneath them, and tunnels need ground above them.
pub(crate) const WITHOUT_GROUND: Damage = Damage::Invalid("spans in a tile without ground");

/// Reads the spans of a tile from the bytes of its payload; empty if it has none. Memory stays
/// within the [`limits`](crate::limits), whatever the bytes say. The triangles to which points
/// refer are those of the tile's TIN.
///
/// `frame` and `quantum_m` are those of the package's manifest. The triangles themselves are not
/// decoded.
///
/// # Errors
/// When the bytes are not a payload of tile `id`, or the section is damaged.
pub fn decode_spans(
    bytes: &[u8],
    id: TileId,
    frame: &GridFrame,
    quantum_m: f64,
) -> Result<Vec<SpanRun>, DecodeError> {
    let (context, sections) = CodingContext::open(bytes, id, frame, quantum_m)?;
    let damaged = SectionKind::Spans.damaged(id);
    let Some(section) = envelope::section(&sections, SectionKind::Spans).map_err(damaged)? else {
        return Ok(Vec::new());
    };
    let ground = terrain::record_in(&sections, context.scale);
    let ground = ground.map_err(SectionKind::Terrain.damaged(id))?;
    let triangles = ground.ok_or(WITHOUT_GROUND).map_err(damaged)?.triangles;
    decode(&section, context.corner, triangles).map_err(damaged)
}

/// Decodes the section's bytes, in a tile with this number of triangles.
pub(crate) fn decode(bytes: &[u8], corner: LatticePoint, triangles: usize) -> Result<Vec<SpanRun>> {
    let cursor = &mut Cursor::new(bytes);
    let count = cursor.bounded(MAX_LINES, "number of runs")?;
    let [codes, ways, lengths] = cursor.columns(count)?;
    let mut room = MAX_SPAN_POINTS;
    let mut points_of = Vec::with_capacity(count);
    for length in lengths.iter() {
        let points = usize::try_from(length).unwrap_or(usize::MAX).saturating_add(2);
        take_room(&mut room, points, MAX_SPAN_POINTS, "points of a section")?;
        points_of.push(points);
    }
    let points = decode_points(cursor, points_of.iter().copied(), corner)?;
    let ends = FIRST_ON_GROUND | LAST_ON_GROUND;
    let on_ground = codes.iter().map(|code| (code & ends).count_ones() as usize).sum();
    let [steps, named] = [cursor.planes(points.len() - on_ground)?, cursor.planes(on_ground)?];
    cursor.finish()?;
    let mut heights = Heights { steps: steps.iter(), named: named.iter(), last: 0, triangles };
    let mut points = points.as_slice();
    let mut runs: Vec<SpanRun> = Vec::with_capacity(count);
    let mut way_id = 0_i64;
    for ((code, way), length) in codes.iter().zip(ways.iter()).zip(points_of) {
        way_id = way_id.wrapping_add(zigzag(way));
        let (of_run, rest) = points.split_at_checked(length).ok_or(Damage::TooShort)?;
        points = rest;
        let run = SpanRun {
            way_id,
            owner: owner(code)?,
            structure: if code & TUNNEL == 0 { Structure::Bridge } else { Structure::Tunnel },
            points: heights.lift(of_run, code)?,
        };
        Damage::invalid_if(
            runs.last().is_some_and(|last| last.key() > run.key()),
            "runs are not sorted",
        )?;
        runs.push(run);
    }
    Ok(runs)
}

/// Returns the owner in a run's first number.
fn owner(code: u64) -> Result<RunOwner> {
    RunOwner::from_number(code >> OWNER_BIT).ok_or(Damage::Invalid("the owner of a run"))
}

/// Decodes the heights of points off the ground, each as the difference from the height before, and
/// the triangles of the other points.
struct Heights<S, N> {
    steps: S,
    named: N,
    last: i64,
    /// The number of triangles of the tile.
    triangles: usize,
}

impl<S: Iterator<Item = u64>, N: Iterator<Item = u64>> Heights<S, N> {
    /// Adds heights to the points of a run.
    fn lift(&mut self, points: &[LatticePoint], code: u64) -> Result<Vec<SpanPoint>> {
        let is_last = iter::repeat_n(false, points.len().saturating_sub(1)).chain([true]);
        let is_first = iter::once(true).chain(iter::repeat(false));
        let lifted = points.iter().zip(is_first.zip(is_last)).map(|(&at, (is_first, is_last))| {
            let on_ground = (is_first && code & FIRST_ON_GROUND != 0)
                || (is_last && code & LAST_ON_GROUND != 0);
            let height = if on_ground { self.triangle()? } else { self.height()? };
            Ok(SpanPoint { at, height })
        });
        lifted.collect()
    }

    fn height(&mut self) -> Result<SpanHeight> {
        let by = zigzag(self.steps.next().unwrap_or_default());
        let height = self.last.checked_add(by).filter(|&steps| is_height(steps));
        self.last = height.ok_or(Damage::Invalid("a height"))?;
        Ok(SpanHeight::Steps(self.last))
    }

    fn triangle(&mut self) -> Result<SpanHeight> {
        let named = u32::try_from(self.named.next().unwrap_or_default()).ok();
        let triangle = named.filter(|&named| (named as usize) < self.triangles);
        let triangle = triangle.ok_or(Damage::Invalid("a triangle under a run"))?;
        Ok(SpanHeight::Ground { triangle })
    }
}

/// Whether ground can have a height of this many steps.
fn is_height(steps: i64) -> bool {
    i32::try_from(steps).is_ok()
}

#[cfg(test)]
#[path = "spans_tests.rs"]
mod tests;
