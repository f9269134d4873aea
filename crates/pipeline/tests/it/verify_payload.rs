//! Changes every field of a payload in turn and reassembles the package with matching checksums:
//! which check detects the change.
//!
//! Fields are listed by patterns that name every field, so that a new field does not compile until
//! it is listed.

#![allow(clippy::unwrap_used, reason = "helpers of tests may unwrap")]

use corniche_testing::some_of;
use std::{
    collections::BTreeMap,
    num::{NonZeroU8, NonZeroU32},
};

use crate::support::{
    parts::{Parts, SOUND},
    seen::{
        SeenBy::{self, By, Refused},
        check, row,
    },
};
use corniche_drape::{DrapedLine, DrapedVertex, SvLine};
use corniche_geom::{HeightGrid, LatticePoint};
use corniche_roads::{Form, FunctionalRoadClass, Oneway, RoadAttributes, Structure};
use corniche_tileset::{GeoRoad, Relief, RoadRecord, SvRoad, TilePayload, TileTerrain};
use corniche_tin::{Tin, TinVertex};
use corniche_verify::CheckId as C;

/// Lists fields of types by patterns that name all fields: a new field does not compile until it is
/// named.
macro_rules! fields {
    ($($type:ident { $($field:ident),* $(,)? })*) => {
        const PAYLOAD: &[&str] = &[$($(concat!(stringify!($type), ".", stringify!($field)),)*)*];
        $(const _: fn($type) = |$type { $($field: _),* }| ();)*
    };
}

fields! {
    TilePayload { id, terrain, relief, roads_geo, roads_sv, attributes }
    TileTerrain { tin, normals, geometric_error_m, height_range_m, uncovered_nodes }
    TinVertex { row, column, height_q }
    GeoRoad { way_id, part, class, line }
    DrapedLine { lead_in, vertices, lead_out }
    SvRoad { way_id, part, class, line }
    SvLine { points, ground_range_m }
    LatticePoint { u, v }
    RoadRecord { way_id, attributes }
    RoadAttributes {
        form, structure, layer, oneway, name, reference, surface,
        highway, lanes, width_mm, max_speed, sac_scale, tracktype,
    }
}

/// Lists the variants of a vertex, and values without public fields.
const VARIANTS: &[&str] = &[
    "Source.point",
    "Source.triangle",
    "Crossing.a",
    "Crossing.b",
    "Vertex.vertex",
    "Tin.triangles",
];
const _: fn(DrapedVertex) = |vertex| match vertex {
    DrapedVertex::Source { point: _, triangle: _ }
    | DrapedVertex::Crossing { a: _, b: _ }
    | DrapedVertex::Vertex { vertex: _ } => (),
};

/// A field of a payload, a change to it, and the check that detects it.
type PayloadChange = (&'static str, fn(&mut Parts), SeenBy);

const CHANGES: &[PayloadChange] = &[
    ("TilePayload.terrain", |parts| bare(parts).terrain = None, By(C::LevelSums)),
    ("TilePayload.relief", |parts| bare(parts).relief = None, By(C::ReliefThere)),
    ("TilePayload.relief", other_relief, By(C::Relief)),
    ("TilePayload.relief", other_relief, By(C::ReliefSeams)),
    ("TilePayload.roads_geo", |parts| drop(busy(parts).roads_geo.remove(0)), By(C::Methods)),
    ("TilePayload.roads_sv", without_sv, By(C::Methods)),
    ("TilePayload.attributes", |parts| drop(busy(parts).attributes.pop()), By(C::Attributes)),
    ("TileTerrain.tin", without_ground, By(C::LevelSums)),
    ("Tin.triangles", flip, By(C::Bound)),
    ("TinVertex.row", |parts| move_vertex(parts, |v| v.row += 1), By(C::Nodes)),
    ("TinVertex.column", |parts| move_vertex(parts, |v| v.column += 1), By(C::Nodes)),
    ("TinVertex.height_q", |parts| move_vertex(parts, |v| v.height_q += 1), By(C::Nodes)),
    ("TileTerrain.normals", |parts| ground(parts).normals[40][1] += 1, By(C::Normals)),
    (
        "TileTerrain.geometric_error_m",
        |parts| ground(parts).geometric_error_m *= 0.999,
        By(C::Bound),
    ),
    ("TileTerrain.height_range_m", |parts| ground(parts).height_range_m[0] -= 0.001, By(C::Ranges)),
    ("TileTerrain.uncovered_nodes", |parts| ground(parts).uncovered_nodes += 1, By(C::Uncovered)),
    ("GeoRoad.way_id", |parts| geo(parts, |road| road.way_id += 1 << 40), By(C::Methods)),
    ("GeoRoad.part", |parts| geo(parts, |road| road.part += 1), By(C::Order)),
    (
        "GeoRoad.class",
        |parts| geo(parts, |road| road.class = other_class(road.class)),
        By(C::Classes),
    ),
    ("GeoRoad.line", |parts| geo(parts, |road| reverse(&mut road.line)), By(C::OsmGeo)),
    ("DrapedLine.lead_in", |parts| lead(parts, |line| &mut line.lead_in), By(C::Methods)),
    ("DrapedLine.lead_out", |parts| lead(parts, |line| &mut line.lead_out), By(C::Methods)),
    ("DrapedLine.vertices", skip_crossing, By(C::OnTin)),
    ("Source.point", move_source, By(C::Methods)),
    ("Source.triangle", |parts| vertex(parts, is_source, other_triangle), Refused),
    ("Crossing.a", |parts| vertex(parts, is_crossing, |v| crossing(v, 0)), By(C::OnTin)),
    ("Crossing.b", |parts| vertex(parts, is_crossing, |v| crossing(v, 1)), By(C::OnTin)),
    ("Vertex.vertex", |parts| vertex(parts, is_crossing, as_vertex), By(C::OnTin)),
    ("SvRoad.way_id", |parts| sv(parts, |road| road.way_id += 1 << 40), By(C::Methods)),
    ("SvRoad.part", |parts| sv(parts, |road| road.part += 1), By(C::Order)),
    (
        "SvRoad.class",
        |parts| sv(parts, |road| road.class = other_class(road.class)),
        By(C::Classes),
    ),
    ("SvRoad.line", |parts| sv(parts, |road| reverse_sv(&mut road.line)), By(C::OsmSv)),
    ("SvLine.points", |parts| sv(parts, |road| road.line.points[1].u += 40), By(C::Methods)),
    ("SvLine.ground_range_m", |parts| range(parts, 0, 1.0), By(C::SvRange)),
    ("SvLine.ground_range_m", |parts| range(parts, 0, -1.0), By(C::SvRange)),
    ("SvLine.ground_range_m", |parts| range(parts, 1, 1.0), By(C::SvRange)),
    ("SvLine.ground_range_m", |parts| range(parts, 1, -1.0), By(C::SvRange)),
    ("LatticePoint.u", |parts| sv(parts, |road| road.line.points[1].u += 1), By(C::OsmSv)),
    ("LatticePoint.v", |parts| sv(parts, |road| road.line.points[1].v += 1), By(C::OsmSv)),
    ("RoadRecord.way_id", |parts| busy(parts).attributes[0].way_id -= 1, By(C::Attributes)),
    ("RoadRecord.attributes", |parts| record(parts, |a| a.name.push('x')), By(C::Attributes)),
    (
        "RoadAttributes.form",
        |parts| everywhere(parts, |a| a.form = Form::Roundabout),
        By(C::OsmAttributes),
    ),
    (
        "RoadAttributes.structure",
        |parts| everywhere(parts, |a| a.structure = Structure::Tunnel),
        By(C::OsmAttributes),
    ),
    ("RoadAttributes.layer", |parts| everywhere(parts, |a| a.layer += 1), By(C::OsmAttributes)),
    (
        "RoadAttributes.oneway",
        |parts| everywhere(parts, |a| a.oneway = Oneway::Backward),
        By(C::OsmAttributes),
    ),
    ("RoadAttributes.name", |parts| everywhere(parts, |a| a.name.push('x')), By(C::OsmAttributes)),
    (
        "RoadAttributes.reference",
        |parts| everywhere(parts, |a| a.reference.push('x')),
        By(C::OsmAttributes),
    ),
    (
        "RoadAttributes.surface",
        |parts| everywhere(parts, |a| a.surface.push('x')),
        By(C::OsmAttributes),
    ),
    (
        "RoadAttributes.highway",
        |parts| everywhere(parts, |a| a.highway.push('x')),
        By(C::OsmAttributes),
    ),
    (
        "RoadAttributes.lanes",
        |parts| everywhere(parts, |a| a.lanes = NonZeroU8::new(a.lanes.map_or(7, |n| n.get() + 1))),
        By(C::OsmAttributes),
    ),
    (
        "RoadAttributes.width_mm",
        |parts| {
            everywhere(parts, |a| {
                a.width_mm = NonZeroU32::new(a.width_mm.map_or(7, |mm| mm.get() + 1));
            });
        },
        By(C::OsmAttributes),
    ),
    (
        "RoadAttributes.max_speed",
        |parts| everywhere(parts, |a| a.max_speed.push('x')),
        By(C::OsmAttributes),
    ),
    (
        "RoadAttributes.sac_scale",
        |parts| everywhere(parts, |a| a.sac_scale.push('x')),
        By(C::OsmAttributes),
    ),
    (
        "RoadAttributes.tracktype",
        |parts| everywhere(parts, |a| a.tracktype.push('x')),
        By(C::OsmAttributes),
    ),
];

/// The relief of other ground: that of a finest tile, turned upside down.
fn other_relief(parts: &mut Parts) {
    let cell = parts.manifest.levels.last().unwrap().cell_m;
    let quantum_m = parts.manifest.vertical.quantum_m;
    let relief = &mut bare(parts).relief;
    let heights = relief.as_ref().unwrap().heights();
    let nearest = |at: usize| at.clamp(1, 257) - 1;
    let with_halo = HeightGrid::from_fn(259, 259, |column, row| {
        heights.height(nearest(column), nearest(row)).map_or(f32::NAN, |height_m| -height_m)
    });
    *relief = Some(Relief::of_heights(&with_halo, &with_halo, cell, quantum_m).unwrap());
}

/// The finest tile with the most roads.
fn busy(parts: &mut Parts) -> &mut TilePayload {
    let id = parts.tiles_above(0).max_by_key(|tile| tile.roads_geo.len()).unwrap().id;
    let index = parts.index_of(id).unwrap();
    &mut parts.tiles[index]
}

/// A finest tile without roads.
fn bare(parts: &mut Parts) -> &mut TilePayload {
    let id = parts.finest_without_roads();
    let index = parts.index_of(id).unwrap();
    &mut parts.tiles[index]
}

fn ground(parts: &mut Parts) -> &mut TileTerrain {
    bare(parts).terrain.as_mut().unwrap()
}

/// Changes the GEO road with the most vertices in the busiest tile, and sorts the roads again.
fn geo(parts: &mut Parts, change: impl Fn(&mut GeoRoad)) {
    let tile = busy(parts);
    let longest =
        (0..tile.roads_geo.len()).max_by_key(|&at| tile.roads_geo[at].line.vertices.len());
    change(&mut tile.roads_geo[longest.unwrap()]);
    tile.roads_geo.sort_by_key(|road| (road.class, road.way_id, road.part));
}

/// Changes the SV road with the most vertices in the busiest tile.
fn sv(parts: &mut Parts, change: impl Fn(&mut SvRoad)) {
    let frame = *parts.frame();
    let tile = busy(parts);
    let bounds = frame.tile_lattice_bounds(tile.id);
    let inside = |road: &SvRoad| {
        let points = &road.line.points;
        if points.len() > 2 && bounds.contains(points[1]) { points.len() } else { 0 }
    };
    let longest = (0..tile.roads_sv.len()).max_by_key(|&at| inside(&tile.roads_sv[at]));
    change(&mut tile.roads_sv[longest.unwrap()]);
    tile.roads_sv.sort_by_key(|road| (road.class, road.way_id, road.part));
}

fn range(parts: &mut Parts, end: usize, steps: f64) {
    let quantum_m = parts.manifest.vertical.quantum_m;
    sv(parts, |road| road.line.ground_range_m[0][end] += steps * quantum_m);
}

/// Ground without a triangle.
fn without_ground(parts: &mut Parts) {
    let ground = ground(parts);
    (ground.tin, ground.normals) = (Tin::default(), Vec::new());
}

/// Removes a way's SV lines; its GEO lines remain.
fn without_sv(parts: &mut Parts) {
    let tile = busy(parts);
    let way_id = tile.roads_geo[0].way_id;
    tile.roads_sv.retain(|road| road.way_id != way_id);
}

fn other_class(class: FunctionalRoadClass) -> FunctionalRoadClass {
    FunctionalRoadClass::new((class.number() + 8) % 9).unwrap()
}

fn reverse(line: &mut DrapedLine) {
    line.vertices.reverse();
    std::mem::swap(&mut line.lead_in, &mut line.lead_out);
}

fn reverse_sv(line: &mut SvLine) {
    line.points.reverse();
    line.ground_range_m.reverse();
}

fn is_source(vertex: &DrapedVertex) -> bool {
    matches!(vertex, DrapedVertex::Source { .. })
}

fn is_crossing(vertex: &DrapedVertex) -> bool {
    matches!(vertex, DrapedVertex::Crossing { .. })
}

/// Changes an inner vertex of the longest line of the busiest tile.
fn vertex(parts: &mut Parts, wanted: fn(&DrapedVertex) -> bool, change: fn(&mut DrapedVertex)) {
    geo(parts, |road| {
        let inner = road.line.vertices.iter_mut().skip(1).find(|vertex| wanted(vertex));
        change(inner.unwrap());
    });
}

fn other_triangle(vertex: &mut DrapedVertex) {
    if let DrapedVertex::Source { triangle, .. } = vertex {
        *triangle = triangle.wrapping_sub(1).min(40);
    }
}

fn crossing(vertex: &mut DrapedVertex, end: usize) {
    if let DrapedVertex::Crossing { a, b } = vertex {
        let end = if end == 0 { a } else { b };
        *end = if *end > 0 { *end - 1 } else { 1 };
    }
}

fn as_vertex(vertex: &mut DrapedVertex) {
    if let DrapedVertex::Crossing { a, .. } = *vertex {
        *vertex = DrapedVertex::Vertex { vertex: a };
    }
}

fn skip_crossing(parts: &mut Parts) {
    geo(parts, |road| {
        let at = road.line.vertices.iter().position(is_crossing).unwrap();
        road.line.vertices.remove(at);
    });
}

/// Moves a source point by a few millimetres, so that it stays in its triangle.
fn move_source(parts: &mut Parts) {
    vertex(parts, is_source, |vertex| {
        if let DrapedVertex::Source { point, .. } = vertex {
            point.v += 40;
        }
    });
}

/// Slightly moves the point before or after a line that has no source point at that end.
fn lead(parts: &mut Parts, end: fn(&mut DrapedLine) -> &mut Option<LatticePoint>) {
    let mut roads = parts.tiles.iter_mut().flat_map(|tile| &mut tile.roads_geo);
    let point = roads.find_map(|road| end(&mut road.line).as_mut()).expect("a line with a lead");
    point.u += 60;
    point.v += 60;
}

/// Changes a vertex inside the ground of a tile without roads.
fn move_vertex(parts: &mut Parts, change: fn(&mut TinVertex)) {
    let tin = &mut ground(parts).tin;
    let is_inner = |v: &TinVertex| (8..248).contains(&v.row) && (8..248).contains(&v.column);
    for at in 0..tin.vertices().len() {
        let mut vertices = tin.vertices().to_vec();
        change(&mut vertices[at]);
        if is_inner(&vertices[at])
            && let Ok(moved) = Tin::from_canonical(vertices, tin.triangles().to_vec())
        {
            *tin = moved;
            return;
        }
    }
    panic!("no vertex can be moved");
}

/// Flips the edge between two triangles where that makes the largest difference.
fn flip(parts: &mut Parts) {
    let tin = &mut ground(parts).tin;
    let at = |v: u32| tin.vertices()[v as usize];
    let triangles = tin.triangles();
    let mut opposite: BTreeMap<(u32, u32), (usize, u32)> = BTreeMap::new();
    for (index, &[a, b, c]) in triangles.iter().enumerate() {
        for (from, to, other) in [(a, b, c), (b, c, a), (c, a, b)] {
            opposite.insert((from, to), (index, other));
        }
    }
    let area = |a: u32, b: u32, c: u32| {
        let [a, b, c] = [a, b, c].map(at).map(|v| [i64::from(v.column), -i64::from(v.row)]);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let mut best: Option<(i64, Tin)> = None;
    for (&(a, b), &(left, c)) in &opposite {
        let Some(&(right, d)) = opposite.get(&(b, a)) else { continue };
        // The edge a–b becomes d–c.
        if a > b || area(a, d, c) <= 0 || area(d, b, c) <= 0 {
            continue;
        }
        let height = |v: u32| i64::from(at(v).height_q);
        let bend = (height(a) + height(b) - height(c) - height(d)).abs();
        if best.as_ref().is_some_and(|(most, _)| *most >= bend) {
            continue;
        }
        let mut others: Vec<[u32; 3]> = triangles.to_vec();
        (others[left], others[right]) = ([a, d, c], [d, b, c]);
        best = Some((bend, Tin::new(tin.vertices().to_vec(), &others).unwrap()));
    }
    *tin = best.unwrap().1;
}

/// Changes a way's attributes in one tile.
fn record(parts: &mut Parts, change: fn(&mut RoadAttributes)) {
    // A way that other tiles have, too: the first way that the busiest tile shares with its parent.
    let parent = busy(parts).id.parent().unwrap();
    let above = parts.index_of(parent).unwrap();
    change(&mut parts.tiles[above].attributes[0].attributes);
}

/// Changes a way's attributes in all tiles.
fn everywhere(parts: &mut Parts, change: fn(&mut RoadAttributes)) {
    let way_id = busy(parts).attributes[0].way_id;
    let records = parts.tiles.iter_mut().flat_map(|tile| &mut tile.attributes);
    for record in records.filter(|record| record.way_id == way_id) {
        change(&mut record.attributes);
    }
}

/// Every field of a payload has a change here, and every change has the expected result.
#[test]
fn every_field_of_a_payload_is_seen() {
    let mut all: Vec<&str> = PAYLOAD.iter().chain(VARIANTS).copied().collect();
    all.sort_unstable();
    // A separate case: a payload with the id of another tile.
    let mut listed: Vec<&str> = CHANGES.iter().map(|&(name, ..)| name).collect();
    listed.push("TilePayload.id");
    listed.sort_unstable();
    listed.dedup();
    assert_eq!(all, listed, "fields without a change in the list (or the other way round)");

    let mut failed = Vec::new();
    println!("{}", row("TilePayload.id", By(C::Whole)));
    for &(name, change, seen) in some_of(CHANGES, [12, 6, 1]) {
        println!("{}", row(name, seen));
        let mut parts = Parts::sound();
        change(&mut parts);
        assert!(parts.tiles != SOUND.parts.tiles, "{name} does not change");
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("changed.pmtiles");
        let found = match parts.write(&path) {
            Err(_) if seen == Refused => Ok(()),
            Err(error) => Err(format!("cannot be encoded: {error:?}")),
            Ok(()) => check(&path, seen),
        };
        if let Err(found) = found {
            failed.push(format!("{name}: expected {seen:?}, found {found}"));
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

/// A payload contains the id of its tile; it is rejected in another tile's place.
#[test]
fn a_payload_in_another_tiles_place_is_seen() {
    let mut tiles = SOUND.encoded.clone();
    let (last, other) = (tiles.len() - 1, tiles.len() - 2);
    let bytes = std::mem::take(&mut tiles[last].1);
    tiles[last].1 = std::mem::replace(&mut tiles[other].1, bytes);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("changed.pmtiles");
    crate::support::parts::write(&path, &SOUND.parts.manifest, &tiles).unwrap();
    assert_eq!(check(&path, By(C::Whole)), Ok(()));
}
