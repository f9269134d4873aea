//! Divides a line of a tile where its bridges are high enough above the ground to be slabs.
//!
//! ```text
//!             ┌─────────────┐          deck
//!   ━━━━━━━━━━╱             ╲━━━━━━    a slab, where the deck leaves the ground; it may be within the ground in part
//!   ───────────╲───────────╱───────    the road is also on the ground where the slab is not entirely above the ground
//!               ╲_________╱
//! ```
//!
//! A slab begins a little above the ground, so its road is never in the plane of the ground. A
//! bridge that is nowhere higher above the ground than its slab's thickness has none.
//!
//! Between places at which the deck or the ground bends, both are straight, so the start of a slab
//! follows from one division.

use corniche_geom::{LatticePoint, StepBudget, TooMuchWork, along};
use corniche_roads::{Structure, slab_thickness_m};
use corniche_tileset::{SpanHeight, SpanRun};

use crate::{
    piece::{Vertex, WayPiece, own_points},
    plane::{distance, nearest_point},
};

/// Points of runs are rounded to the lattice: they are within this many steps of their line.
const NEAR_STEPS: f64 = 2.0;

/// A slab begins where its road is this far above the ground, metres.
const START_M: f64 = 0.1;

/// A stretch of a line in plan.
pub(crate) struct PlanStretch {
    /// At least two points, no two neighbours equal.
    pub(crate) points: Vec<LatticePoint>,
    /// Heights of the deck at the points, in the package's datum; `None` if the road is on the
    /// ground.
    pub(crate) deck_m: Option<Vec<f64>>,
    /// Whether the line continues in another tile from its first point, and from its last.
    pub(crate) goes_on: [bool; 2],
}

impl PlanStretch {
    pub(crate) fn ends(&self) -> [LatticePoint; 2] {
        [self.points[0], self.points[self.points.len() - 1]]
    }

    /// The points after the first one and before the last one.
    pub(crate) fn next_to_ends(&self) -> [LatticePoint; 2] {
        [self.points[1], self.points[self.points.len() - 2]]
    }
}

/// Divides a line along the bridges among the runs of its way: first its slabs, then its parts on
/// the ground. Runs that are not on the line are skipped, and so are parts that other runs have
/// already.
///
/// # Errors
/// When there are more runs over more ground than in any valid package.
pub(crate) fn stretches(
    piece: &WayPiece,
    runs: &[SpanRun],
    quantum_m: f64,
    work: &StepBudget,
) -> Result<Vec<PlanStretch>, TooMuchWork> {
    let line = MeasuredLine::from_vertices(&piece.vertices);
    let thickness_m = slab_thickness_m(piece.class);
    let mut slabs: Vec<Vec<DeckPoint>> = Vec::new();
    let mut bare: Vec<[DeckPoint; 2]> = Vec::new();
    for run in runs.iter().filter(|run| run.structure == Structure::Bridge) {
        work.check()?;
        if let Some(places) = line.places(run, work) {
            let deck = line.deck(run, &places, quantum_m);
            let wholly_above = high_parts(&deck, &line, thickness_m).into_iter();
            bare.extend(wholly_above.map(|part| [part[0], part[part.len() - 1]]));
            slabs.extend(high_parts(&deck, &line, START_M));
        }
    }
    let along = |point: &DeckPoint| point.along;
    bare.sort_by(|[one, _], [other, _]| along(one).total_cmp(&along(other)));
    slabs.sort_by(|one, other| along(&one[0]).total_cmp(&along(&other[0])));
    let mut found = Vec::new();
    let mut from = f64::NEG_INFINITY;
    let mut kept: Vec<[f64; 2]> = Vec::new();
    for slab in slabs {
        let [first, last] = [slab[0], slab[slab.len() - 1]].map(|point| point.along);
        let goes_on = [
            piece.goes_on[0] && first <= NEAR_STEPS,
            piece.goes_on[1] && last >= line.length() - NEAR_STEPS,
        ];
        let is_high = bare.iter().any(|[start, _]| start.along >= first && start.along <= last);
        // The height in the next tile is unknown here, and the result must be the same in both.
        if first < from || !(is_high || goes_on.contains(&true)) {
            continue;
        }
        from = last;
        kept.push([first, last]);
        found.push(PlanStretch {
            points: slab.iter().map(|point| point.at).collect(),
            deck_m: Some(slab.iter().map(|point| point.deck_m).collect()),
            goes_on,
        });
    }
    let mut from = Cut { along: f64::NEG_INFINITY, at: None };
    for [first, last] in bare {
        // Where another run's slab was skipped, the road stays on the ground.
        let is_kept = kept.iter().any(|[start, end]| first.along >= *start && last.along <= *end);
        if first.along < from.along || !is_kept {
            continue;
        }
        let to = Cut { along: first.along, at: Some(first.at) };
        found.extend(line.on_ground([from, to], piece.goes_on));
        from = Cut { along: last.along, at: Some(last.at) };
    }
    found.extend(line.on_ground([from, Cut { along: f64::INFINITY, at: None }], piece.goes_on));
    Ok(found)
}

/// A place at which a line is divided, or one of its ends.
#[derive(Clone, Copy)]
struct Cut {
    along: f64,
    /// `None` at an end of the line.
    at: Option<LatticePoint>,
}

/// A point of a deck.
#[derive(Clone, Copy)]
struct DeckPoint {
    /// Lattice steps along the line.
    along: f64,
    at: LatticePoint,
    deck_m: f64,
}

/// A place at which a deck or the ground beneath it bends.
struct Station {
    along: f64,
    deck_m: f64,
    over_m: f64,
    /// A point of the run.
    point: Option<LatticePoint>,
}

/// A line on the ground with the distance along it of each vertex.
struct MeasuredLine<'a> {
    vertices: &'a [Vertex],
    /// Lattice steps from the first vertex.
    along: Vec<f64>,
}

impl<'a> MeasuredLine<'a> {
    fn from_vertices(vertices: &'a [Vertex]) -> Self {
        let mut sum = 0.0;
        let mut along = vec![sum];
        for [from, to] in vertices.array_windows() {
            sum += distance(from.at, to.at);
            along.push(sum);
        }
        Self { vertices, along }
    }

    fn length(&self) -> f64 {
        self.along[self.along.len() - 1]
    }

    /// Returns the segment that contains a place on the line, and the share of the segment before
    /// it.
    fn segment_at(&self, along: f64) -> (usize, f64) {
        let last = self.vertices.len() - 2;
        let segment = self.along.partition_point(|own| *own <= along).saturating_sub(1).min(last);
        let [from, to] = [self.along[segment], self.along[segment + 1]];
        let share = (along - from) / (to - from);
        (segment, if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 })
    }

    /// Returns the place and the ground's height there.
    fn at(&self, along: f64) -> Vertex {
        let (segment, share) = self.segment_at(along);
        let [from, to] = [self.vertices[segment], self.vertices[segment + 1]];
        from.towards(to, share)
    }

    /// Returns the distance along a segment of the place nearest to a point, and its distance from
    /// the point.
    fn nearest(&self, segment: usize, point: [f64; 2]) -> (f64, f64) {
        let [from, to] = [self.vertices[segment].at, self.vertices[segment + 1].at];
        let whole = distance(from, to);
        let by = |axis: usize| (point[axis] - from[axis]) * (to[axis] - from[axis]);
        let share = ((by(0) + by(1)) / (whole * whole)).clamp(0.0, 1.0);
        let share = if share.is_finite() { share } else { 0.0 };
        (self.along[segment] + share * whole, distance(along(from, to, share), point))
    }

    /// Returns the distances along the line of the points of a run; `None` if the run belongs to
    /// another line of the way.
    fn places(&self, run: &SpanRun, work: &StepBudget) -> Option<Vec<f64>> {
        let first = run.points[0].at.in_steps();
        work.add(self.vertices.len());
        (0..self.vertices.len() - 1).find_map(|segment| {
            let (along, beside) = self.nearest(segment, first);
            if beside > NEAR_STEPS {
                return None;
            }
            work.add(run.points.len());
            self.follow(run, along)
        })
    }

    /// Returns the same for a run whose first point is known. All points at which the line turns
    /// are points of the run, so between two of them it is straight.
    fn follow(&self, run: &SpanRun, first: f64) -> Option<Vec<f64>> {
        let mut places = vec![first];
        let mut before = first;
        for [from, to] in run.points.array_windows() {
            let (segment, _) = self.segment_at(before + from.at.distance_steps(to.at));
            let (along, beside) = self.nearest(segment, to.at.in_steps());
            if beside > NEAR_STEPS || along < before {
                return None;
            }
            places.push(along);
            before = along;
        }
        Some(places)
    }

    /// Returns the deck of a run over the ground, with its points at these places.
    fn deck(&self, run: &SpanRun, places: &[f64], quantum_m: f64) -> Vec<Station> {
        let of_run = run.points.iter().zip(places).map(|(point, &along)| {
            let ground_m = self.at(along).z_m;
            let deck_m = match point.height {
                SpanHeight::Steps(steps) => steps as f64 * quantum_m,
                SpanHeight::Ground { .. } => ground_m,
            };
            Station { along, deck_m, over_m: deck_m - ground_m, point: Some(point.at) }
        });
        let mut stations: Vec<Station> = Vec::with_capacity(places.len());
        for next in of_run {
            if let Some(&Station { along: from, deck_m: from_m, .. }) = stations.last() {
                let inside = self.along.partition_point(|own| *own <= from)
                    ..self.along.partition_point(|own| *own < next.along);
                for index in inside {
                    let along = self.along[index];
                    let share = (along - from) / (next.along - from);
                    let deck_m = from_m + share * (next.deck_m - from_m);
                    let over_m = deck_m - self.vertices[index].z_m;
                    stations.push(Station { along, deck_m, over_m, point: None });
                }
            }
            stations.push(next);
        }
        stations
    }

    /// Returns the part of the line on the ground between two cuts, if it has a length.
    fn on_ground(&self, [from, to]: [Cut; 2], goes_on: [bool; 2]) -> Option<PlanStretch> {
        // A line that ends where the ground ends has no point of its own there.
        let own = own_points(self.vertices).filter(|(index, _)| {
            let along = self.along[*index];
            along > from.along && along < to.along
        });
        let inside = own.map(|(_, vertex)| nearest_point(vertex.at));
        let mut points: Vec<LatticePoint> =
            from.at.into_iter().chain(inside).chain(to.at).collect();
        points.dedup();
        let goes_on = [from.at.is_none() && goes_on[0], to.at.is_none() && goes_on[1]];
        (points.len() > 1).then_some(PlanStretch { points, deck_m: None, goes_on })
    }
}

/// Returns the parts of a deck that are at least this far above the ground.
fn high_parts(deck: &[Station], line: &MeasuredLine<'_>, least_m: f64) -> Vec<Vec<DeckPoint>> {
    let is_high = |station: &Station| station.over_m >= least_m;
    let mut parts: Vec<Vec<DeckPoint>> = Vec::new();
    let mut before: Option<&Station> = None;
    for station in deck {
        let cut = before.filter(|from| is_high(from) != is_high(station)).map(|from| {
            let share = (least_m - from.over_m) / (station.over_m - from.over_m);
            let along = from.along + share * (station.along - from.along);
            let at = line.at(along).at;
            let deck_m = from.deck_m + share * (station.deck_m - from.deck_m);
            DeckPoint { along, at: nearest_point(at), deck_m }
        });
        if is_high(station) && (before.is_none() || cut.is_some()) {
            parts.push(Vec::new());
        }
        if let Some(part) = parts.last_mut() {
            part.extend(cut);
            if let (Some(at), true) = (station.point, is_high(station)) {
                part.push(DeckPoint { along: station.along, at, deck_m: station.deck_m });
            }
        }
        before = Some(station);
    }
    for part in &mut parts {
        part.dedup_by_key(|point| point.at);
    }
    parts.retain(|part| part.len() > 1);
    parts
}

#[cfg(test)]
#[path = "stretches_tests.rs"]
mod tests;
