//! Bridges of a tile as lines in space.

use corniche_geom::GridFrame;
use corniche_roads::Structure;
use corniche_tileset::{SpanHeight, SpanRun};
use corniche_tin::Surface;

use super::{RoadKind, flat_ends::LineEnds};

/// A bridge, or a part of one, above the ground of its tile.
#[derive(Debug, Clone, PartialEq)]
pub struct DeckLine {
    /// OSM's id of the way.
    pub way_id: i64,
    /// Kind of the road.
    pub kind: RoadKind,
    /// Whether it is a road, and not a line of a layer.
    pub is_road: bool,
    /// x, y in the working CRS and true height of the road at each point.
    pub points_m: Vec<[f64; 3]>,
    /// Whether the first and the last point are on the ground.
    pub on_ground: [bool; 2],
}

impl DeckLine {
    /// The first and the last segment, each towards the line's end.
    pub(crate) fn ends(&self) -> Option<LineEnds> {
        let plan = |at: &[f64; 3]| [at[0], at[1]];
        let [first, second] = [self.points_m.first()?, self.points_m.get(1)?].map(plan);
        let mut from_last = self.points_m.iter().rev().map(plan);
        let [last, before] = [from_last.next()?, from_last.next()?];
        Some(LineEnds::of_deck([[second, first], [before, last]]))
    }
}

/// The bridges among runs on a tile's ground, as far as `kind` returns one.
pub(crate) fn deck_lines<'a>(
    runs: impl Iterator<Item = &'a SpanRun>,
    kind: impl Fn(&SpanRun) -> Option<RoadKind>,
    surface: &Surface,
    (frame, quantum_m): (&GridFrame, f64),
) -> Vec<DeckLine> {
    let bridges = runs.filter(|run| run.structure == Structure::Bridge);
    let deck = |run: &SpanRun| {
        let kind = kind(run)?;
        let points_m = run.points.iter().filter_map(|point| {
            let [x, y] = frame.position_m(point.at);
            // The reader has checked that this triangle exists.
            Some([x, y, point.height_m(surface, quantum_m)?])
        });
        let on_ground = [run.points.first(), run.points.last()].map(|point| {
            point.is_some_and(|point| matches!(point.height, SpanHeight::Ground { .. }))
        });
        let (way_id, is_road) = (run.way_id, run.owner.layer().is_none());
        Some(DeckLine { way_id, kind, is_road, points_m: points_m.collect(), on_ground })
    };
    bridges.filter_map(deck).collect()
}
