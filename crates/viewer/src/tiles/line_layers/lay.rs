//! Drapes lines of layers and lines from users' files on the ground of a tile.

use std::collections::{BTreeMap, BTreeSet};

use corniche_drape::{ClippedPart, OwnedBorders};
use corniche_geom::{GridFrame, LatticePoint, Polyline, StepBudget, TileId, TooMuchWork};
use corniche_roads::{FunctionalRoadClass, Structure};
use corniche_tileset::SpanRun;
use corniche_tin::Surface;

use super::{
    LineMethods, StyledLine, TileLayer,
    dashes::{DashPlaces, GroundLengths},
};
use crate::tiles::{
    GroundLine, PlanScale, RoadKind, RoadLook, TileLines,
    relief::RoadRelief,
    roads::{PlanLine, deck_lines, draped_points_m, portals},
    shares_in,
};

/// Segments longer than this many cells of the level are divided, so that dashes follow the ground.
const LONGEST_CELLS: f64 = 8.0;

/// The ground of a tile on which lines are draped.
pub struct TileSurface {
    pub(crate) id: TileId,
    pub(crate) surface: Surface,
    pub(crate) frame: GridFrame,
    /// The height step, metres.
    pub(crate) quantum_m: f64,
    /// The tile's reference point.
    pub(crate) reference_m: [f64; 3],
    /// Maximum half width of drawn lines, working metres.
    pub(crate) width_margin_m: f64,
    pub(crate) scale: PlanScale,
    /// World height of a metre of true height without exaggeration.
    pub(crate) vertical_scale: f64,
    /// Maximum number of steps for draping lines.
    pub(crate) most_steps: u64,
}

impl TileSurface {
    /// Drapes lines on the ground. Lines that are not near the ground are omitted.
    ///
    /// # Errors
    /// When draping takes too much work, which depends on the number of triangles that the lines
    /// cross.
    pub fn lay(
        &self,
        lines: &[StyledLine],
        methods: LineMethods,
    ) -> Result<TileLayer, TooMuchWork> {
        self.lay_within((lines, &[]), methods, &StepBudget::new(self.most_steps))
    }

    /// Does the same as [`TileSurface::lay`] with a budget of work, and with the bridges and
    /// tunnels among the lines: only the parts that are not off the ground are draped on it.
    pub(crate) fn lay_within(
        &self,
        (lines, spans): (&[StyledLine], &[&SpanRun]),
        methods: LineMethods,
        work: &StepBudget,
    ) -> Result<TileLayer, TooMuchWork> {
        let mut ground = Vec::new();
        let mut plan = Vec::new();
        for line in lines {
            let Some(class) = FunctionalRoadClass::new(line.style) else { continue };
            let Ok(path) = Polyline::new(divided(&line.points, self, work)?) else { continue };
            let (laid, places) = on_ground(&path, line.id, class, self, work)?;
            if methods != LineMethods::Geometry {
                plan.extend(in_plan(&path, line.id, class, &places, (self, work))?);
            }
            if methods != LineMethods::ShadowVolumes {
                ground.extend(laid);
            }
        }
        let Self { width_margin_m, scale, .. } = *self;
        let laid = TileLines { ground, plan, width_margin_m, scale, ..TileLines::default() };
        let laid = with_spans(laid, lines, spans, self);
        let relief =
            RoadRelief::new(self.id, Some(&self.surface), &self.frame, width_margin_m, work);
        let in_tile = (self.frame.tile_bounds(self.id), self.reference_m);
        let (layer, _) = TileLayer::of_lines(&laid, &relief, in_tile, work);
        work.check()?;
        Ok(layer)
    }
}

/// Adds to lines of a tile the decks of bridges among `runs`, and makes bores of tunnels.
fn with_spans(
    lines: TileLines,
    styled: &[StyledLine],
    runs: &[&SpanRun],
    on: &TileSurface,
) -> TileLines {
    if runs.is_empty() {
        return lines;
    }
    let class = |line: &StyledLine| Some((line.id, FunctionalRoadClass::new(line.style)?));
    let styles: BTreeMap<i64, _> = styled.iter().filter_map(class).collect();
    let runs = runs.iter().copied().filter(|run| styles.contains_key(&run.way_id));
    let kind = |run: &SpanRun| styles.get(&run.way_id).copied().map(RoadKind::plain);
    let of = |structure| {
        let own = runs.clone().filter(move |run| run.structure == structure);
        own.map(|run| run.way_id).collect::<BTreeSet<i64>>()
    };
    let [bridges, tunnels] = [Structure::Bridge, Structure::Tunnel].map(of);
    let mut lines = TileLines {
        decks: deck_lines(runs.clone(), kind, &on.surface, (&on.frame, on.quantum_m)),
        portals: portals(runs.clone(), &on.frame),
        bridges: bridges.into_iter().collect(),
        ..lines
    };
    for (_, kind) in lines.kinds_mut().filter(|(way_id, _)| tunnels.contains(way_id)) {
        kind.look = RoadLook::Bore;
    }
    lines
}

/// The points of a line near the tile, with additional lattice points in long segments. Each
/// additional point is within half a step of the line.
fn divided(
    points: &[LatticePoint],
    on: &TileSurface,
    work: &StepBudget,
) -> Result<Vec<LatticePoint>, TooMuchWork> {
    let [east, north] = on.frame.node_steps(on.id.z());
    let longest = LONGEST_CELLS * east.min(north) as f64;
    let margin = (on.width_margin_m / on.frame.lattice_step_m()).ceil() as i64;
    let around = on.frame.tile_lattice_bounds(on.id).expanded(margin + longest.ceil() as i64);
    let around = [[around.min.u, around.max.u], [around.min.v, around.max.v]]
        .map(|of| of.map(|at| at as f64));
    let mut divided: Vec<LatticePoint> = points.first().copied().into_iter().collect();
    for [from, to] in points.array_windows::<2>() {
        let (du, dv) = ((to.u - from.u) as f64, (to.v - from.v) as f64);
        let parts = (libm::hypot(du, dv) / longest).ceil().max(1.0);
        // A segment may go all around the earth: only the part near the tile is divided.
        let [first, last] = shares_in(from.in_steps(), [du, dv], around, 1.0);
        let numbers = (first * parts).floor().max(1.0) as u64..=(last * parts).ceil() as u64;
        work.add(((last - first) * parts).max(0.0) as usize);
        work.check()?;
        for part in numbers.take_while(|part| (*part as f64) < parts) {
            let share = part as f64 / parts;
            divided.push(LatticePoint::new(
                from.u + (du * share).round() as i64,
                from.v + (dv * share).round() as i64,
            ));
        }
        divided.push(*to);
    }
    divided.dedup();
    Ok(divided)
}

/// Returns a line on the ground, and its dash positions.
fn on_ground(
    path: &Polyline,
    id: i64,
    class: FunctionalRoadClass,
    on: &TileSurface,
    work: &StepBudget,
) -> Result<(Vec<GroundLine>, DashPlaces), TooMuchWork> {
    let frame = on.frame;
    let tile = frame.tile_lattice_bounds(on.id);
    let points_m = path.points().iter().map(|&point| frame.position_m(point)).collect();
    let mut lengths = GroundLengths::new(points_m);
    // Each line with the segments of `path` that contain its source segments.
    let mut found: Vec<(GroundLine, Vec<usize>)> = Vec::new();
    for part in corniche_drape::clip_parts(path, &tile, OwnedBorders::ALL) {
        for draped in corniche_drape::drape_within(&part.line, &on.surface, work)?.lines {
            let Ok(points_m) = draped_points_m(&draped, &on.surface, &frame) else { continue };
            let sources = corniche_drape::source_segments(&draped);
            let segments = segments_of(&sources, &part);
            for (pair, &segment) in points_m.array_windows::<2>().zip(&segments) {
                lengths.add(segment, *pair, on.vertical_scale);
            }
            let sources_m =
                sources.into_iter().map(|ends| ends.map(|point| frame.position_m(point)));
            let line = GroundLine {
                way_id: id,
                kind: RoadKind::plain(class),
                points_m,
                sources_m: sources_m.collect(),
                dashes: None,
            };
            found.push((line, segments));
        }
    }
    let places = lengths.places();
    let with_dashes = |(line, segments): (GroundLine, Vec<usize>)| {
        let mut sources: Vec<_> = line.sources_m.iter().zip(segments).collect();
        sources.dedup_by_key(|(source_m, _)| *source_m);
        let dash = |(source_m, segment): (&[[f64; 2]; 2], usize)| places.at(segment, source_m[0]);
        let dashes = Some(sources.into_iter().map(dash).collect());
        GroundLine { dashes, ..line }
    };
    let lines = found.into_iter().map(with_dashes).collect();
    Ok((lines, places))
}

/// For each piece of a draped line, the index of its segment in the path. `sources` are segments of
/// `part`, in order.
fn segments_of(sources: &[[LatticePoint; 2]], part: &ClippedPart) -> Vec<usize> {
    let points = part.line.points();
    let mut at = 0;
    let mut number = |source: &[LatticePoint; 2]| {
        while at + 2 < points.len() && points[at..at + 2] != source[..] {
            at += 1;
        }
        part.segments.get(at).copied().unwrap_or_default()
    };
    sources.iter().map(&mut number).collect()
}

fn in_plan(
    path: &Polyline,
    id: i64,
    class: FunctionalRoadClass,
    places: &DashPlaces,
    (on, work): (&TileSurface, &StepBudget),
) -> Result<Vec<PlanLine>, TooMuchWork> {
    let frame = on.frame;
    let margin = (on.width_margin_m / frame.lattice_step_m()).floor() as i64;
    let around = frame.tile_lattice_bounds(on.id).expanded(margin);
    let mut lines = Vec::new();
    for part in corniche_drape::clip_parts(path, &around, OwnedBorders::ALL) {
        for line in corniche_drape::extrude_within(&part.line, &on.surface, margin, work)? {
            let points_m: Vec<[f64; 2]> =
                line.points.iter().map(|&point| frame.position_m(point)).collect();
            let sources: Vec<[LatticePoint; 2]> = line.points.array_windows().copied().collect();
            let segments = segments_of(&sources, &part);
            let dashes =
                segments.iter().zip(&points_m).map(|(&segment, at)| places.at(segment, *at));
            lines.push(PlanLine {
                way_id: id,
                kind: RoadKind::plain(class),
                dashes: Some(dashes.collect()),
                points_m,
                ground_range_m: line.ground_range_m,
            });
        }
    }
    Ok(lines)
}

#[cfg(test)]
#[path = "lay_tests.rs"]
mod tests;
