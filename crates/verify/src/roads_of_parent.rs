//! Checks that a road is on every level that shows its class, by comparing each tile with its parent.

use std::collections::BTreeMap;

use corniche_geom::{LatticeBounds, LatticePoint, Work};
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
    let place = TilePlace::of(frame, above);
    let own_place = TilePlace::of(frame, id);
    // Points on a border were made by cutting; the source does not have them.
    let is_inside = |point: LatticePoint| {
        let LatticeBounds { min, max } = bounds;
        (min.u + 1..max.u).contains(&point.u) && (min.v + 1..max.v).contains(&point.v)
    };

    let work = Work::new(MOST_STEPS);
    let is_within = || work.check().is_ok();
    let tolerance = levels.simplify_tolerance_steps(above.z());
    if tolerance <= levels.margin_steps(above.z()) as f64 {
        let lines = sv_lines(parent.payload, place);
        for road in &child.payload.roads_geo {
            if !levels.shows(above.z(), road.class) {
                continue;
            }
            let line = lines.get(&road.way_id);
            let points = source_points(&road.line).filter(|&point| is_inside(point));
            for point in points.take_while(|_| is_within()) {
                let at = place.local(point);
                if parent.ground.height_m(place.cells(at)).is_none() {
                    continue;
                }
                let reach = tolerance + SAME_LINE_STEPS;
                let is_there = line.is_some_and(|line| line.is_on(at, reach, &work));
                findings.look(CheckId::Shown, is_there, || {
                    format!("way {} of tile {id} is not in tile {above} at {point:?}", road.way_id)
                });
            }
        }
    }

    let tolerance = levels.simplify_tolerance_steps(id.z());
    if tolerance <= levels.margin_steps(id.z()) as f64 {
        let lines = sv_lines(child.payload, own_place);
        for road in &parent.payload.roads_sv {
            let line = lines.get(&road.way_id);
            let points = road.line.points.iter().filter(|&&point| is_inside(point));
            for &point in points.take_while(|_| is_within()) {
                let at = own_place.local(point);
                if child.ground.height_m(own_place.cells(at)).is_none() {
                    continue;
                }
                let reach = tolerance + SAME_LINE_STEPS;
                let is_there = line.is_some_and(|line| line.is_on(at, reach, &work));
                findings.look(CheckId::Shown, is_there, || {
                    format!("way {} of tile {above} is not in tile {id} at {point:?}", road.way_id)
                });
            }
        }
    }
    if let Err(error) = work.check() {
        findings.look(CheckId::Shown, false, || too_much(id, error));
    }
}

fn sv_lines(payload: &TilePayload, place: TilePlace) -> BTreeMap<i64, NearSegments> {
    let mut lines: BTreeMap<i64, Vec<Segment>> = BTreeMap::new();
    for road in &payload.roads_sv {
        lines.entry(road.way_id).or_default().extend(segments(&road.line.points, place));
    }
    lines.into_iter().map(|(way_id, segments)| (way_id, NearSegments::new(segments))).collect()
}
