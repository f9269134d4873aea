//! Compares a tile's GEO lines with its SV lines: the GEO lines lie on the SV lines, and wherever
//! there is ground beneath an SV line, a GEO line lies on it. Also checks the height ranges of SV
//! segments.

use std::collections::{BTreeMap, BTreeSet};

use corniche_drape::{DrapedLine, DrapedVertex};
use corniche_geom::{LatticePoint, StepBudget, TileId, TooMuchWork};
use corniche_tileset::TilePayload;

use super::{
    checks::{CheckId, Findings},
    near_index::NearIndex,
    tile_place::TilePlace,
    triangle_soup::TriangleSoup,
};

/// The distance of two lines that still count as coinciding, in lattice steps: each is rounded
/// where it is cut.
pub(crate) const SAME_LINE_STEPS: f64 = 2.0;
/// Shorter pieces are ignored, in lattice steps.
const LEAST_STEPS: f64 = 8.0;
/// The build widens ranges by this part of the heights before it rounds them outwards (FORMAT.md,
/// section 8).
const RANGE_PAD: f64 = 1e-6;
/// The relative tolerance of that widening, because the heights are computed in two ways.
const PAD_ROUNDING: f64 = 1e-3;

/// The limit of work for a tile, in steps: comparing a pair of segments or reading a triangle is
/// one step. Real tiles take a few million steps, and those with the finest cells and the most
/// roads a hundred times as many, because their margins contain all triangles.
pub(crate) const MOST_STEPS: u64 = 1 << 30;

/// A segment in local steps.
pub(crate) type LocalSegment = [[f64; 2]; 2];

/// The lines of one way in a tile.
#[derive(Default)]
struct Way {
    /// The source points and leads of its GEO lines.
    points: BTreeSet<LatticePoint>,
    /// The straight pieces of its GEO lines, where there is ground.
    geo: Vec<LocalSegment>,
    /// The points of its SV lines.
    sv_points: BTreeSet<LatticePoint>,
    sv: Vec<LocalSegment>,
}

/// A tile with its ground, and the place of both on the lattice.
pub(crate) struct TileView<'a> {
    pub payload: &'a TilePayload,
    pub ground: &'a TriangleSoup,
    pub place: TilePlace,
    /// The distance around an SV segment that its height range covers, in lattice steps.
    pub margin_steps: i64,
    pub quantum_m: f64,
}

/// Compares the lines of both methods; `positions` are the vertices of the GEO lines.
pub(crate) fn verify_lines(
    view: &TileView<'_>,
    positions: &[Option<Vec<[f64; 3]>>],
    findings: &mut Findings,
) {
    let id = view.payload.id;
    let work = StepBudget::new(MOST_STEPS);
    let is_within = || work.check().is_ok();
    for ((class, way_id), way) in ways(view, positions) {
        let Way { points, geo, sv_points, sv } = way;
        let [sv, geo] = [sv, geo].map(NearSegments::new);
        let name = || format!("way {way_id} of class {class} in tile {id}");
        for &point in points.iter().take_while(|_| is_within()) {
            let at = view.place.local(point);
            let holds = sv_points.contains(&point) || sv.is_on(at, SAME_LINE_STEPS, &work);
            look!(
                findings,
                Methods,
                holds,
                "{}: the GEO line passes {point:?}, where there is no SV line",
                name()
            );
        }
        for &segment in sv.segments.iter().take_while(|_| is_within()) {
            let lines = geo.near(segment, SAME_LINE_STEPS, &work).take_while(|_| is_within());
            let bare = bare_pieces(view.place, segment, lines);
            let bare = bare.into_iter().find(|&piece| {
                view.ground.meets(piece.map(|point| view.place.cells(point)), &work)
            });
            look!(
                findings,
                Methods,
                bare.is_none(),
                "{}: no GEO line on the ground beneath the SV line from {:?}",
                name(),
                segment[0]
            );
        }
        // Lines that were compared only in part prove nothing, and may have been reported as bare.
        if let Err(error) = work.check() {
            findings.look(CheckId::Methods, false, || too_much(id, error));
            return;
        }
    }
}

/// The finding for a tile whose lines overlap too often.
pub(crate) fn too_much(id: TileId, error: TooMuchWork) -> String {
    format!(
        "tile {id}: so many segments lie near each other that no writer can have created them: {error}"
    )
}

fn ways(view: &TileView<'_>, positions: &[Option<Vec<[f64; 3]>>]) -> BTreeMap<(u8, i64), Way> {
    let place = view.place;
    let mut ways: BTreeMap<(u8, i64), Way> = BTreeMap::new();
    for (road, positions) in view.payload.roads_geo.iter().zip(positions) {
        let way = ways.entry((road.class.number(), road.way_id)).or_default();
        way.points.extend(road.line.lead_in.iter().chain(&road.line.lead_out));
        let Some(positions) = positions else { continue };
        let at = |index: usize| place.local_of([positions[index][0], positions[index][1]]);
        let mut from = 0;
        for (index, vertex) in road.line.vertices.iter().enumerate() {
            let is_last = index + 1 == road.line.vertices.len();
            if let DrapedVertex::Source { point, .. } = vertex {
                way.points.insert(*point);
            } else if !is_last {
                continue;
            }
            if index > from {
                way.geo.push([at(from), at(index)]);
            }
            from = index;
        }
    }
    for road in &view.payload.roads_sv {
        let way = ways.entry((road.class.number(), road.way_id)).or_default();
        way.sv_points.extend(&road.line.points);
        way.sv.extend(segments(&road.line.points, place));
    }
    ways
}

/// The segments of a line, in local steps.
pub(crate) fn segments(
    points: &[LatticePoint],
    place: TilePlace,
) -> impl Iterator<Item = LocalSegment> + '_ {
    points.windows(2).map(move |pair| [place.local(pair[0]), place.local(pair[1])])
}

/// The source points of a GEO line, including those beyond its ground.
pub(crate) fn source_points(line: &DrapedLine) -> impl Iterator<Item = LatticePoint> + '_ {
    let own = line.vertices.iter().filter_map(|vertex| match vertex {
        DrapedVertex::Source { point, .. } => Some(*point),
        DrapedVertex::Crossing { .. } | DrapedVertex::Vertex { .. } => None,
    });
    line.lead_in.into_iter().chain(own).chain(line.lead_out)
}

/// The segments of a way, indexed by position.
pub(crate) struct NearSegments {
    segments: Vec<LocalSegment>,
    index: NearIndex,
}

impl NearSegments {
    pub(crate) fn new(segments: Vec<LocalSegment>) -> Self {
        let index = NearIndex::new(segments.iter().copied());
        Self { segments, index }
    }

    /// All segments within `reach` of the box around two points, and perhaps others.
    fn near(
        &self,
        corners: LocalSegment,
        reach: f64,
        work: &StepBudget,
    ) -> impl Iterator<Item = LocalSegment> {
        self.index.near(corners, reach, work).map(|number| self.segments[number])
    }

    /// Whether a point lies within `steps` of one of the segments.
    pub(crate) fn is_on(&self, point: [f64; 2], steps: f64, work: &StepBudget) -> bool {
        self.near([point; 2], steps, work).any(|segment| distance(point, segment) <= steps)
    }
}

/// The distance of a point from a segment.
pub(crate) fn distance(point: [f64; 2], [a, b]: LocalSegment) -> f64 {
    let (du, dv) = (b[0] - a[0], b[1] - a[1]);
    let squared = du * du + dv * dv;
    let ahead = (point[0] - a[0]) * du + (point[1] - a[1]) * dv;
    // A segment of length 0 is a point.
    let part = if squared > 0.0 { (ahead / squared).clamp(0.0, 1.0) } else { 0.0 };
    (a[0] + part * du - point[0]).hypot(a[1] + part * dv - point[1])
}

/// The pieces of a segment that lie in the tile but on none of the lines. A segment along a border
/// has no such pieces, because its line may belong to the neighbour.
fn bare_pieces(
    place: TilePlace,
    segment: LocalSegment,
    lines: impl Iterator<Item = LocalSegment>,
) -> Vec<LocalSegment> {
    let [p, q] = segment;
    let (du, dv) = (q[0] - p[0], q[1] - p[1]);
    let length = du.hypot(dv);
    let [east, south] = place.reach();
    // Both are whole numbers.
    let is_at = |at: f64, border: f64| (at - border).abs() < 0.5;
    let is_on_border = |axis: usize, border: f64| is_at(p[axis], border) && is_at(q[axis], border);
    if [(0, 0.0), (0, east), (1, 0.0), (1, south)].iter().any(|&(axis, at)| is_on_border(axis, at))
    {
        return Vec::new();
    }
    let (mut from, mut to) = (0.0_f64, length);
    for (at, way, low, high) in [(p[0], du / length, 0.0, east), (p[1], dv / length, south, 0.0)] {
        if way == 0.0 {
            if at < low || at > high {
                return Vec::new();
            }
            continue;
        }
        let ends = [(low - at) / way, (high - at) / way];
        from = from.max(ends[0].min(ends[1]));
        to = to.min(ends[0].max(ends[1]));
    }
    let mut covered: Vec<[f64; 2]> = lines
        .filter_map(|ends| {
            let [a, b] = ends.map(|[u, v]| {
                let (u, v) = (u - p[0], v - p[1]);
                [(u * du + v * dv) / length, (v * du - u * dv) / length]
            });
            let is_beside = a[1].abs().max(b[1].abs()) <= SAME_LINE_STEPS;
            is_beside.then_some([a[0].min(b[0]), a[0].max(b[0])])
        })
        .collect();
    covered.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
    covered.push([to, to]);
    let mut pieces = Vec::new();
    let mut at = from;
    for [low, high] in covered {
        if low.min(to) - at > LEAST_STEPS {
            let point = |along: f64| [p[0] + along / length * du, p[1] + along / length * dv];
            pieces.push([point(at), point(low.min(to))]);
        }
        at = at.max(high);
    }
    pieces
}

/// Checks the height range of every SV segment.
pub(crate) fn verify_ranges(view: &TileView<'_>, findings: &mut Findings) {
    let id = view.payload.id;
    // One step more than the margin, because ground exactly at the margin counts.
    let margin = view.margin_steps as f64 + 1.0;
    let work = StepBudget::new(MOST_STEPS);
    for road in &view.payload.roads_sv {
        let lines = segments(&road.line.points, view.place).zip(&road.line.ground_range_m);
        for (segment, &[low_m, high_m]) in lines {
            let ends = segment.map(|point| view.place.cells(point));
            if let Err(error) = work.check() {
                look!(
                    findings,
                    SvRange,
                    false,
                    "tile {id}: its segments lie over so much ground that no writer can have created them: {error}"
                );
                return;
            }
            let found = view.ground.range_near(ends, margin, &work);
            let holds = found.is_some_and(|[lowest_m, highest_m]| {
                let size_m = lowest_m.abs().max(highest_m.abs()).max(highest_m - lowest_m);
                let steps = |height_m: f64| height_m / view.quantum_m;
                let [less_m, more_m] =
                    [1.0 - PAD_ROUNDING, 1.0 + PAD_ROUNDING].map(|part| part * RANGE_PAD * size_m);
                let lows = steps(lowest_m - more_m).floor()..=steps(lowest_m - less_m).floor();
                let highs = steps(highest_m + less_m).ceil()..=steps(highest_m + more_m).ceil();
                lows.contains(&steps(low_m)) && highs.contains(&steps(high_m))
            });
            look!(
                findings,
                SvRange,
                holds,
                "way {} part {} in tile {id} has a segment with ground from {low_m} to {high_m} m, but it is \
                     {found:?}",
                road.way_id,
                road.part
            );
        }
    }
}

#[cfg(test)]
#[path = "geo_against_sv_tests.rs"]
mod tests;
