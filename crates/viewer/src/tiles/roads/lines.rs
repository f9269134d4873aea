//! The roads of a decoded tile as lines: on the ground for GEO, in plan for SV.

use corniche_drape::{BadLine, DrapedLine};
use corniche_geom::{GridFrame, TooMuchWork};
use corniche_roads::{FunctionalRoadClass, Structure};
use corniche_tileset::{SpanHeight, SpanPoint, SpanRun, TilePayload};
use corniche_tin::Surface;

use super::{super::PlanScale, DashPlace, DeckLine, RoadKind, deck_line::deck_lines};
use crate::options::Mapping;

/// A road on the ground (GEO): its centre-line, draped on the tile's TIN.
#[derive(Debug, Clone, PartialEq)]
pub struct GroundLine {
    /// OSM's id of the way.
    pub way_id: i64,
    /// Kind of the road.
    pub kind: RoadKind,
    /// x, y in the working CRS and true height of each vertex.
    pub points_m: Vec<[f64; 3]>,
    /// For each piece between two vertices, both ends in plan of its segment in the source line.
    /// Between two pieces of one segment the road is straight.
    pub sources_m: Vec<[[f64; 2]; 2]>,
    /// Dash positions of the start of each segment of the source line that has pieces; `None`: as
    /// for roads.
    pub dashes: Option<Vec<DashPlace>>,
}

impl GroundLine {
    /// A line whose vertices are the points of the source line, without a width of its own.
    #[must_use]
    pub fn of_source(way_id: i64, class: FunctionalRoadClass, points_m: Vec<[f64; 3]>) -> Self {
        let plan = |[x, y, _]: [f64; 3]| [x, y];
        let sources_m = points_m.windows(2).map(|pair| [plan(pair[0]), plan(pair[1])]).collect();
        Self { way_id, kind: RoadKind::plain(class), points_m, sources_m, dashes: None }
    }
}

/// A road in plan (SV), in the tile and its margin.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanLine {
    /// OSM's id of the way.
    pub way_id: i64,
    /// Kind of the road.
    pub kind: RoadKind,
    /// x, y in the working CRS.
    pub points_m: Vec<[f64; 2]>,
    /// The lowest and highest true height of the tile's ground within the width margin of each
    /// segment.
    pub ground_range_m: Vec<[f64; 2]>,
    /// Dash positions of the start of each segment; `None`: as for roads.
    pub dashes: Option<Vec<DashPlace>>,
}

/// The roads of a tile.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TileLines {
    /// Roads on the ground; empty if that section was not read.
    pub ground: Vec<GroundLine>,
    /// Roads in plan; empty if that section was not read.
    pub plan: Vec<PlanLine>,
    /// Bridges above the ground; empty if the package has none, or that section was not read.
    pub decks: Vec<DeckLine>,
    /// Points where tunnels emerge from the ground, in plan.
    pub portals: Vec<[f64; 2]>,
    /// The ways of bridges, in order of their ids; empty if the package does not store where
    /// bridges are above the ground.
    pub bridges: Vec<i64>,
    /// How far the plan lines extend beyond the tile; this is the maximum half width of drawn
    /// roads.
    pub width_margin_m: f64,
    /// Working metres per true metre; 1 by default.
    pub scale: PlanScale,
    /// Whether the roads on the ground are draped on it.
    pub mapping: Mapping,
}

/// Why a road of a tile cannot be drawn: the package is damaged.
#[derive(Debug, thiserror::Error)]
#[error("part {part} of way {way_id} does not fit the tile's ground")]
pub struct BadRoad {
    /// OSM's id of the way.
    pub way_id: i64,
    /// Part of the way.
    pub part: u32,
    /// Description of the fault.
    pub source: BadLine,
}

/// Why the roads of a tile cannot be drawn.
#[derive(Debug, thiserror::Error)]
pub enum BadRoads {
    /// A road does not fit the ground.
    #[error(transparent)]
    Road(#[from] BadRoad),
    /// The segments are near more triangles than any writer can have intended.
    #[error("the roads of the tile cannot be placed on its ground")]
    TooMuch(#[from] TooMuchWork),
}

impl TileLines {
    /// The roads of a payload with these spans (bridges and tunnels), as far as their sections were
    /// read, placed on its `surface`. `width_margin_m` belongs to the tile's level.
    pub(crate) fn of_payload(
        payload: &TilePayload,
        spans: Option<&[SpanRun]>,
        surface: Option<&Surface>,
        (frame, quantum_m): (&GridFrame, f64),
        width_margin_m: f64,
    ) -> Result<Self, BadRoad> {
        let ground =
            surface.map_or(Ok(Vec::new()), |surface| ground_lines(payload, surface, frame))?;
        let plan = plan_lines(payload, frame);
        let lines = Self { ground, plan, width_margin_m, ..Self::default() };
        let Some(spans) = spans else { return Ok(lines) };
        let kind =
            |run: &SpanRun| Some(RoadKind::tagged(payload, run.way_id, run.owner.road_class()?));
        let decks = surface.map_or_else(Vec::new, |surface| {
            deck_lines(spans.iter(), kind, surface, (frame, quantum_m))
        });
        let bridges = payload.attributes.iter();
        let bridges = bridges.filter(|record| record.attributes.structure == Structure::Bridge);
        let bridges = bridges.map(|record| record.way_id).collect();
        let of_roads = spans.iter().filter(|run| run.owner.layer().is_none());
        let mut lines = Self { decks, portals: portals(of_roads, frame), bridges, ..lines };
        for (_, kind) in lines.kinds_mut() {
            kind.look = kind.look.with_portals();
        }
        Ok(lines)
    }

    /// The ways and kinds of all lines on the ground and in plan.
    pub(crate) fn kinds_mut(&mut self) -> impl Iterator<Item = (i64, &mut RoadKind)> {
        let ground = self.ground.iter_mut().map(|line| (line.way_id, &mut line.kind));
        ground.chain(self.plan.iter_mut().map(|line| (line.way_id, &mut line.kind)))
    }
}

/// Tunnels shorter than this, in working metres, are underpasses and have no portals.
const SHORTEST_TUNNEL_M: f64 = 80.0;

/// Points where tunnels emerge from the ground.
pub(crate) fn portals<'a>(
    spans: impl Iterator<Item = &'a SpanRun>,
    frame: &GridFrame,
) -> Vec<[f64; 2]> {
    let is_on_ground = |point: &SpanPoint| matches!(point.height, SpanHeight::Ground { .. });
    let is_long = |run: &&SpanRun| {
        let steps = run.points.windows(2).map(|pair| pair[0].at.distance_steps(pair[1].at));
        let length_m = steps.sum::<f64>() * frame.lattice_step_m();
        // Another tile may have the rest of the tunnel.
        let is_whole =
            [run.points.first(), run.points.last()].into_iter().flatten().all(is_on_ground);
        !is_whole || length_m >= SHORTEST_TUNNEL_M
    };
    let tunnels = spans.filter(|run| run.structure == Structure::Tunnel).filter(is_long);
    let on_ground = tunnels.flat_map(|run| &run.points).filter(|point| is_on_ground(point));
    on_ground.map(|point| frame.position_m(point.at)).collect()
}

/// Recomputes the positions of a tile's clipped roads from its ground.
fn ground_lines(
    payload: &TilePayload,
    surface: &Surface,
    frame: &GridFrame,
) -> Result<Vec<GroundLine>, BadRoad> {
    let mut lines = Vec::with_capacity(payload.roads_geo.len());
    for road in &payload.roads_geo {
        let points_m = draped_points_m(&road.line, surface, frame).map_err(|source| BadRoad {
            way_id: road.way_id,
            part: road.part,
            source,
        })?;
        lines.push(GroundLine {
            way_id: road.way_id,
            kind: RoadKind::tagged(payload, road.way_id, road.class),
            points_m,
            sources_m: corniche_drape::source_segments(&road.line)
                .into_iter()
                .map(|ends| ends.map(|point| frame.position_m(point)))
                .collect(),
            dashes: None,
        });
    }
    Ok(lines)
}

/// The vertices of a draped line: x, y in the working CRS and true heights.
pub(crate) fn draped_points_m(
    line: &DrapedLine,
    surface: &Surface,
    frame: &GridFrame,
) -> Result<Vec<[f64; 3]>, BadLine> {
    let place = |[u, v, height_m]: [f64; 3]| {
        let [x, y] = frame.position_of_fraction_m([u, v]);
        [x, y, height_m]
    };
    Ok(corniche_drape::positions(line, surface)?.into_iter().map(place).collect())
}

fn plan_lines(payload: &TilePayload, frame: &GridFrame) -> Vec<PlanLine> {
    let place = |road: &corniche_tileset::SvRoad| PlanLine {
        way_id: road.way_id,
        kind: RoadKind::tagged(payload, road.way_id, road.class),
        points_m: road.line.points.iter().map(|point| frame.position_m(*point)).collect(),
        ground_range_m: road.line.ground_range_m.clone(),
        dashes: None,
    };
    payload.roads_sv.iter().map(place).collect()
}
