//! Checks that a road is on every level that shows its class, by comparing each tile with its parent.

use std::collections::BTreeMap;

use corniche_geom::{LatticeBounds, LatticePoint, TileId, Work};
use corniche_spec::levels::Levels;
use corniche_tileset::TilePayload;

use super::{
    checks::{CheckId, Findings},
    geo_against_sv::{
        MOST_STEPS, NearSegments, SAME_LINE_STEPS, Segment, segments, source_points, too_much,
    },
    tile_place::TilePlace,
    triangle_soup::TriangleSoup,
};

/// One of the two tiles.
pub(crate) struct Side<'a> {
    pub payload: &'a TilePayload,
    pub(crate) ground: &'a TriangleSoup,
}

/// Compares the roads of a tile with those of its parent.
///
/// Simplification moves no point of the source farther than the level's tolerance from the line, so wherever both
/// tiles have ground, points of the one lie beside the line of the other, on the level of that line's tolerance.
pub(crate) fn verify(
    child: &Side<'_>,
    parent: &Side<'_>,
    levels: &Levels,
    findings: &mut Findings,
) {
    let (id, above) = (child.payload.id, parent.payload.id);
    let frame = levels.frame();
    let bounds = frame.tile_lattice_bounds(id);
    // Points on a border were made by cutting; the source does not have them.
    let is_inside = |point: LatticePoint| {
        let LatticeBounds { min, max } = bounds;
        (min.u + 1..max.u).contains(&point.u) && (min.v + 1..max.v).contains(&point.v)
    };

    let work = Work::new(MOST_STEPS);
    // Looks for points of a way of one tile beside the lines of the other, which has ground there.
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
                findings.look(CheckId::Shown, is_there, || {
                    format!("way {way_id} of tile {here} is not in tile {there} at {point:?}")
                });
            }
        };
    let reach = |level: u8| {
        let tolerance = levels.simplify_tolerance_steps(level);
        let is_known = tolerance <= levels.margin_steps(level) as f64;
        is_known.then_some(tolerance + SAME_LINE_STEPS)
    };
    if let Some(reach) = reach(above.z()) {
        let lines = Lines::of(parent, TilePlace::of(frame, above), reach, [id, above]);
        for road in &child.payload.roads_geo {
            if levels.shows(above.z(), road.class) {
                look(road.way_id, &mut source_points(&road.line), &lines);
            }
        }
    }
    if let Some(reach) = reach(id.z()) {
        let lines = Lines::of(child, TilePlace::of(frame, id), reach, [above, id]);
        for road in &parent.payload.roads_sv {
            look(road.way_id, &mut road.line.points.iter().copied(), &lines);
        }
    }
    if let Err(error) = work.check() {
        findings.look(CheckId::Shown, false, || too_much(id, error));
    }
}

/// The SV lines of a tile, beside which points of the other one are looked for.
struct Lines<'a> {
    side: &'a Side<'a>,
    place: TilePlace,
    by_way: BTreeMap<i64, NearSegments>,
    /// How far beside them points may lie, steps.
    reach: f64,
    /// The tile that has the points, and the one that has the lines.
    names: [TileId; 2],
}

impl<'a> Lines<'a> {
    fn of(side: &'a Side<'a>, place: TilePlace, reach: f64, names: [TileId; 2]) -> Self {
        let mut by_way: BTreeMap<i64, Vec<Segment>> = BTreeMap::new();
        for road in &side.payload.roads_sv {
            by_way.entry(road.way_id).or_default().extend(segments(&road.line.points, place));
        }
        let lines = by_way.into_iter();
        let by_way = lines.map(|(way_id, own)| (way_id, NearSegments::new(own))).collect();
        Self { side, place, by_way, reach, names }
    }
}
