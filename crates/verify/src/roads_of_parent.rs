//! Checks that a road is on every level that shows its class, by comparing each tile with its
//! parent.

use std::collections::BTreeMap;

use corniche_geom::{LatticeBounds, LatticePoint, StepBudget, TileId};
use corniche_spec::levels::Levels;
use corniche_tileset::TilePayload;

use super::{
    checks::{CheckId, Findings},
    geo_against_sv::{
        LocalSegment, MOST_STEPS, NearSegments, SAME_LINE_STEPS, segments, source_points, too_much,
    },
    tile_place::TilePlace,
    triangle_soup::TriangleSoup,
};

/// One of two compared tiles.
pub(crate) struct ComparedTile<'a> {
    pub payload: &'a TilePayload,
    pub ground: &'a TriangleSoup,
}

/// Compares the roads of a tile with those of its parent.
///
/// Simplification moves no point of the source farther than the level's tolerance from the line.
/// Therefore, wherever both tiles have ground, points of one tile lie near the line of the other,
/// within the tolerance of that line's level.
pub(crate) fn verify(
    child: &ComparedTile<'_>,
    parent: &ComparedTile<'_>,
    levels: &Levels,
    findings: &mut Findings,
) {
    let (id, above) = (child.payload.id, parent.payload.id);
    let frame = levels.frame();
    let bounds = frame.tile_lattice_bounds(id);
    // Points on a border come from cutting; the source does not have them.
    let is_inside = |point: LatticePoint| {
        let LatticeBounds { min, max } = bounds;
        (min.u + 1..max.u).contains(&point.u) && (min.v + 1..max.v).contains(&point.v)
    };

    let work = StepBudget::new(MOST_STEPS);
    // Looks for points of a way in one tile near the lines of the other tile, if the other has
    // ground there.
    let mut look =
        |way_id: i64, points: &mut dyn Iterator<Item = LatticePoint>, in_other: &Lines| {
            let line = in_other.by_way.get(&way_id);
            let points = points.filter(|&point| is_inside(point));
            for point in points.take_while(|_| work.check().is_ok()) {
                let at = in_other.place.local(point);
                if in_other.side.ground.height_m(in_other.place.cells(at)).is_none() {
                    continue;
                }
                let is_there = line.is_some_and(|line| line.is_on(at, in_other.reach, &work));
                let [here, there] = in_other.names;
                look!(
                    findings,
                    Shown,
                    is_there,
                    "way {way_id} of tile {here} is not in tile {there} at {point:?}"
                );
            }
        };
    let reach = |level: u8| {
        let tolerance = levels.simplify_tolerance_steps(level);
        let is_known = tolerance <= levels.margin_steps(level) as f64;
        is_known.then_some(tolerance + SAME_LINE_STEPS)
    };
    if let Some(reach) = reach(above.z()) {
        let lines =
            Lines::from_side(parent, TilePlace::from_frame(frame, above), reach, [id, above]);
        for road in &child.payload.roads_geo {
            if levels.shows(above.z(), road.class) {
                look(road.way_id, &mut source_points(&road.line), &lines);
            }
        }
    }
    if let Some(reach) = reach(id.z()) {
        let lines = Lines::from_side(child, TilePlace::from_frame(frame, id), reach, [above, id]);
        for road in &parent.payload.roads_sv {
            look(road.way_id, &mut road.line.points.iter().copied(), &lines);
        }
    }
    if let Err(error) = work.check() {
        findings.look(CheckId::Shown, false, || too_much(id, error));
    }
}

/// The SV lines of a tile, near which points of the other tile are searched for.
struct Lines<'a> {
    side: &'a ComparedTile<'a>,
    place: TilePlace,
    by_way: BTreeMap<i64, NearSegments>,
    /// The allowed distance of points, in lattice steps.
    reach: f64,
    /// The tile of the points, and the tile of the lines.
    names: [TileId; 2],
}

impl<'a> Lines<'a> {
    fn from_side(
        side: &'a ComparedTile<'a>,
        place: TilePlace,
        reach: f64,
        names: [TileId; 2],
    ) -> Self {
        let mut by_way: BTreeMap<i64, Vec<LocalSegment>> = BTreeMap::new();
        for road in &side.payload.roads_sv {
            by_way.entry(road.way_id).or_default().extend(segments(&road.line.points, place));
        }
        let lines = by_way.into_iter();
        let by_way = lines.map(|(way_id, own)| (way_id, NearSegments::new(own))).collect();
        Self { side, place, by_way, reach, names }
    }
}
