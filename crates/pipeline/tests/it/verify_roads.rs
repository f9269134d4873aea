//! `verify` detects errors of roads across tiles, levels and methods, and differences from the
//! extract.

#![allow(clippy::unwrap_used, reason = "helpers of tests may unwrap")]

use std::collections::BTreeMap;

use crate::support::parts::{Against, Parts, SOUND, assert_broken, encode_in, report_on};
use corniche_drape::DrapedVertex;
use corniche_geom::TileId;
use corniche_roads::FunctionalRoadClass;
use corniche_tileset::{Distribution, EncodeError, TilePayload};
use corniche_verify::CheckId;

/// A level above the finest that shows classes of the sample.
const ABOVE: u8 = 1;

/// A way inside tiles of that level, and its class.
fn way_above(parts: &Parts) -> (i64, FunctionalRoadClass) {
    let tile = parts.tiles_above(ABOVE).max_by_key(|tile| tile.roads_geo.len()).unwrap();
    let longest = tile.roads_geo.iter().max_by_key(|road| road.line.vertices.len()).unwrap();
    (longest.way_id, longest.class)
}

/// Changes the tiles of that level, and updates the growth table.
fn change(parts: &mut Parts, change: impl Fn(&mut TilePayload)) {
    let level = parts.frame().max_level() - ABOVE;
    for tile in parts.tiles.iter_mut().filter(|tile| tile.id.z() == level) {
        change(tile);
    }
    let mut sums: BTreeMap<u8, [u64; 2]> = BTreeMap::new();
    for tile in parts.tiles.iter().filter(|tile| tile.id.z() == level) {
        for road in &tile.roads_geo {
            sums.entry(road.class.number()).or_default()[0] += road.line.vertices.len() as u64;
        }
        for road in &tile.roads_sv {
            sums.entry(road.class.number()).or_default()[1] += road.line.points.len() as u64;
        }
    }
    for row in parts.manifest.growth.iter_mut().filter(|row| row.level == level) {
        [row.geo_vertices, row.sv_vertices] = sums.remove(&row.class).unwrap_or_default();
        row.geo_raw_bytes = 24 * row.geo_vertices;
    }
}

#[test]
fn no_check_is_broken_when_nothing_was_changed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("same.pmtiles");
    SOUND.parts.write(&path).unwrap();
    let report = assert_broken(report_on(&path, Against::Osm), &[]);
    // The package has no photos, no layers and no spans.
    let mut others = report.checks.iter().filter(|check| {
        let id = check.id.id();
        let others = [
            "photo.",
            "areas.",
            "lines.",
            "points.",
            "layers.",
            "osm.areas",
            "osm.lines",
            "osm.points",
            "osm.layers",
            "spans.",
            "osm.spans",
            "P6.structures",
        ];
        !others.iter().any(|start| id.starts_with(start))
    });
    assert!(others.all(|check| check.checked > 0), "{:#?}", report.checks);
}

#[test]
fn a_road_missing_on_a_coarser_level() {
    let mut parts = Parts::sound();
    let (way_id, _) = way_above(&parts);
    change(&mut parts, |tile| {
        tile.roads_geo.retain(|road| road.way_id != way_id);
        tile.roads_sv.retain(|road| road.way_id != way_id);
        tile.attributes.retain(|record| record.way_id != way_id);
    });
    parts.assert_breaks(Against::Itself, &[CheckId::Shown]);
}

#[test]
fn a_road_missing_on_a_coarser_level_in_one_method() {
    let mut without_sv = Parts::sound();
    let (way_id, _) = way_above(&without_sv);
    change(&mut without_sv, |tile| tile.roads_sv.retain(|road| road.way_id != way_id));
    without_sv.assert_breaks(Against::Itself, &[CheckId::Methods, CheckId::Shown]);

    let mut without_geo = Parts::sound();
    change(&mut without_geo, |tile| tile.roads_geo.retain(|road| road.way_id != way_id));
    without_geo.assert_breaks(Against::Itself, &[CheckId::Methods]);
}

#[test]
fn a_class_that_differs_between_levels() {
    let mut parts = Parts::sound();
    let (way_id, class) = way_above(&parts);
    let other = FunctionalRoadClass::new(class.number().saturating_sub(1)).unwrap();
    assert_ne!(class, other);
    change(&mut parts, |tile| {
        tile.roads_geo
            .iter_mut()
            .filter(|road| road.way_id == way_id)
            .for_each(|road| road.class = other);
        tile.roads_sv
            .iter_mut()
            .filter(|road| road.way_id == way_id)
            .for_each(|road| road.class = other);
        tile.roads_geo.sort_by_key(|road| (road.class, road.way_id, road.part));
        tile.roads_sv.sort_by_key(|road| (road.class, road.way_id, road.part));
    });
    parts.assert_breaks(Against::Itself, &[CheckId::Classes]);
}

#[test]
fn a_name_that_differs_between_levels_and_one_that_the_extract_has_not() {
    let mut parts = Parts::sound();
    let (way_id, _) = way_above(&parts);
    let rename = |tile: &mut TilePayload| {
        let named = tile.attributes.iter_mut().filter(|record| record.way_id == way_id);
        named.for_each(|record| record.attributes.name = "Way of Nowhere".to_owned());
    };
    change(&mut parts, rename);
    parts.assert_breaks(Against::Itself, &[CheckId::Attributes]);

    // The change is the same in all tiles: only the comparison with the extract detects it.
    parts.tiles.iter_mut().for_each(rename);
    parts.assert_breaks(Against::Itself, &[]);
    parts.assert_breaks(Against::Osm, &[CheckId::OsmAttributes]);
}

/// A point outside the tile's border has no GEO line beneath it; the extract determines its
/// position, to the step.
#[test]
fn an_sv_point_in_the_margin_moved_by_a_lattice_step() {
    let mut parts = Parts::sound();
    let frame = *parts.frame();
    let outside = |id: TileId, tile: &TilePayload| {
        tile.roads_sv.iter().position(|road| {
            let points = &road.line.points;
            points.len() > 2 && !frame.tile_lattice_bounds(id).contains(points[1])
        })
    };
    let (index, road) = (0..parts.tiles.len())
        .rev()
        .find_map(|index| {
            let tile = &parts.tiles[index];
            let bounds = frame.tile_lattice_bounds(tile.id);
            let road = outside(tile.id, tile)?;
            // The new point is wholly outside, so that no segment extends over the tile.
            let points = &tile.roads_sv[road].line.points;
            points[..3].iter().all(|&point| !bounds.contains(point)).then_some((index, road))
        })
        .expect("a line in a margin");
    parts.tiles[index].roads_sv[road].line.points[1].u += 1;
    parts.assert_breaks(Against::Osm, &[CheckId::OsmSv]);
}

#[test]
fn stored_errors_three_times_too_large() {
    let mut parts = Parts::sound();
    for tile in &mut parts.tiles {
        if let Some(terrain) = &mut tile.terrain {
            terrain.geometric_error_m *= 3.0;
        }
    }
    for level in &mut parts.manifest.levels {
        let of_level = parts.tiles.iter().filter(|tile| tile.id.z() == level.level);
        let errors_m = of_level.filter_map(|tile| Some(tile.terrain.as_ref()?.geometric_error_m));
        level.errors_m = Distribution::from_values(errors_m.collect());
        level.geometric_error_m = level.errors_m.unwrap().max;
    }
    parts.assert_breaks(Against::Itself, &[]);
    parts.assert_breaks(Against::Dem, &[CheckId::Tight, CheckId::Recorded]);
}

#[test]
fn growth_that_the_extract_does_not_have() {
    let mut parts = Parts::sound();
    let row = parts.manifest.growth.last_mut().unwrap();
    row.source_vertices += 5;
    row.source_bytes += 80;
    parts.assert_breaks(Against::Itself, &[]);
    parts.assert_breaks(Against::Osm, &[CheckId::OsmGrowth]);
}

/// Roads out of order are never in a package, because the encoding rejects them.
#[test]
fn roads_out_of_order_cannot_be_encoded() {
    let mut parts = Parts::sound();
    let tile = parts.tiles.iter_mut().find(|tile| tile.roads_geo.len() > 1).unwrap();
    tile.roads_geo.swap(0, 1);
    let id = tile.id;
    let refused = encode_in(&parts.manifest, &parts.tiles[parts.index_of(id).unwrap()]);
    assert!(
        matches!(&refused, Err(EncodeError::Unencodable { tile, what, .. })
            if *tile == id && what.contains("not sorted")),
        "{refused:?}"
    );
}

#[test]
fn a_road_dropped_from_a_finest_tile() {
    let mut parts = Parts::sound();
    let id = parts.tiles_above(0).max_by_key(|tile| tile.roads_geo.len()).unwrap().id;
    let index = parts.index_of(id).unwrap();
    parts.tiles[index].roads_geo.pop();
    parts.assert_breaks(Against::Itself, &[CheckId::Methods, CheckId::Length, CheckId::Growth]);
}

/// The tile, road and vertex of the first vertex inside a line that meets the condition, `above`
/// levels above the finest.
fn find_vertex(
    parts: &Parts,
    above: u8,
    wanted: impl Fn(&DrapedVertex) -> bool,
) -> (TileId, usize, usize) {
    parts
        .tiles_above(above)
        .find_map(|tile| {
            tile.roads_geo.iter().enumerate().find_map(|(road, geo)| {
                let inner = &geo.line.vertices[1..geo.line.vertices.len() - 1];
                Some((tile.id, road, inner.iter().position(&wanted)? + 1))
            })
        })
        .expect("a line with such a vertex")
}

#[test]
fn a_line_that_skips_the_edge_it_crosses() {
    let mut parts = Parts::sound();
    let is_crossing = |vertex: &DrapedVertex| matches!(vertex, DrapedVertex::Crossing { .. });
    let (id, road, vertex) = find_vertex(&parts, 0, is_crossing);
    let index = parts.index_of(id).unwrap();
    // The line continues straight on, so that its length in plan does not change.
    parts.tiles[index].roads_geo[road].line.vertices.remove(vertex);
    parts.assert_breaks(Against::Itself, &[CheckId::OnTin, CheckId::Growth]);
}

#[test]
fn a_line_with_a_point_moved_far_away() {
    let mut parts = Parts::sound();
    let is_source = |vertex: &DrapedVertex| matches!(vertex, DrapedVertex::Source { .. });
    // The level is above the finest, where lengths are not counted.
    let (id, road, vertex) = find_vertex(&parts, 1, is_source);
    let surface = parts.surface(id);
    let index = parts.index_of(id).unwrap();
    let DrapedVertex::Source { point: from, triangle: near } =
        parts.tiles[index].roads_geo[road].line.vertices[vertex]
    else {
        unreachable!("it was found so")
    };
    let corner = |triangle: usize| surface.points()[surface.triangles()[triangle][0] as usize];
    let far = (0..surface.triangles().len())
        .max_by(|&a, &b| {
            let away_steps = |triangle| corner(triangle).distance_steps(from);
            away_steps(a).total_cmp(&away_steps(b))
        })
        .unwrap();

    // Naming the old triangle with the new point, or the new triangle with the old point, is
    // invalid.
    for (point, triangle) in [(corner(far), near), (from, far as u32)] {
        parts.tiles[index].roads_geo[road].line.vertices[vertex] =
            DrapedVertex::Source { point, triangle };
        let refused = encode_in(&parts.manifest, &parts.tiles[index]);
        assert!(matches!(refused, Err(EncodeError::Unencodable { .. })), "{refused:?}");
    }

    parts.tiles[index].roads_geo[road].line.vertices[vertex] =
        DrapedVertex::Source { point: corner(far), triangle: far as u32 };
    parts.assert_breaks(Against::Itself, &[CheckId::OnTin, CheckId::Methods]);
}
