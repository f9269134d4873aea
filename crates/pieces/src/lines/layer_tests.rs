//! Every tile has the segments of lines near it, and junctions are preserved.

use std::collections::{BTreeMap, BTreeSet};

use std::sync::LazyLock;

use corniche_geom::{GridFrame, LatticeBounds, LatticeRegion, NodeIndex};
use corniche_layers::LayerTable;
use corniche_presets::{layer_preset, parse_layer_table};
use corniche_roads::{ClassFilter, FrcTable};
use corniche_spec::{RoadSettings, data_tiles::DataTiles};
use corniche_testing::FlatProjection;

use super::*;

/// Boundaries, which have classes for large and for small cells.
static TABLE: LazyLock<LayerTable> =
    LazyLock::new(|| parse_layer_table(layer_preset("boundaries").unwrap()).unwrap());

fn class(id: &str) -> u8 {
    TABLE.classes().iter().position(|class| class.id == id).unwrap() as u8
}

/// Three levels of tiles with cells of 10, 20 and 40 m.
fn levels() -> Levels {
    let frame = GridFrame::new([0.0, 0.0], 10.0, NodeIndex { i: -512, j: 512 }, 2).unwrap();
    let table = FrcTable::new("one", vec![("primary".into(), 0)], Vec::new(), 8).unwrap();
    let settings =
        RoadSettings { table, filter: ClassFilter::all(), simplify_cells: 0.25, spans: false };
    Levels::new(frame, 1.0, &settings, 1.0)
}

const PROJECTION: FlatProjection =
    FlatProjection { origin_m: [0.0; 2], origin_deg: [0.0; 2], metres_per_degree: [1e5; 2] };

fn lengths(levels: &Levels) -> TrueLengths<'static> {
    TrueLengths::projected(*levels.frame(), &PROJECTION)
}

fn splitting<'a>(levels: &'a Levels, lengths: &'a TrueLengths<'a>) -> LineSplitting<'a> {
    let [south_west, north_east] = [[-512, -512], [511, 511]].map(|[i, j]| NodeIndex { i, j });
    let data = DataTiles::between(levels.frame(), south_west, north_east);
    let plan =
        PlanSplitting { table: &TABLE, frame: levels.frame(), data, clip: None, polygon: None };
    LineSplitting { plan, levels, lengths, spans: LayerSlot::new(0) }
}

/// A wave across the whole root, in metres; its middle is a junction.
fn wave(levels: &Levels) -> LayerLine {
    let point = |k: i32| {
        let x = f64::from(k) * 20.0 - 5000.0;
        levels.frame().snap([x, 900.0 * (x / 700.0).sin()]).unwrap()
    };
    let points: Vec<LatticePoint> = (0..=500).map(point).collect();
    let (class, fixed) = (class("admin-2"), vec![0, 250, 500]);
    let structure = Structure::Ground;
    LayerLine { way_id: 7, structure, class, values: vec![None; 3], points, fixed }
}

fn part(line: &LayerLine) -> LinePart<'_> {
    let LayerLine { points, fixed, .. } = line;
    LinePart { points: Cow::Borrowed(points), fixed: Cow::Borrowed(fixed), along_um: Vec::new() }
}

#[test]
fn every_tile_has_the_segments_that_come_near_it() {
    let levels = levels();
    let lengths = lengths(&levels);
    let (splitting, boundary) = (splitting(&levels, &lengths), wave(&levels));
    let mut by_tile: BTreeMap<TileId, Vec<Vec<LatticePoint>>> = BTreeMap::new();
    for (id, part) in splitting.split(&boundary) {
        by_tile.entry(id).or_default().push(part.points);
    }
    for level in levels.numbers() {
        let line = splitting.line(&part(&boundary), level).points;
        let step = splitting.plan.step(level);
        assert!(line.iter().all(|point| point.u % step == 0 && point.v % step == 0));
        let margin = levels.margin_steps(level);
        let side = 1_u32 << level;
        for id in (0..side * side).map(|k| TileId::new(level, k % side, k / side).unwrap()) {
            let around = levels.frame().tile_lattice_bounds(id).expanded(margin);
            let touches =
                |pair: &&[LatticePoint; 2]| pair.iter().any(|point| around.contains(*point));
            let needed: BTreeSet<[LatticePoint; 2]> =
                line.array_windows().filter(touches).copied().collect();
            let found: BTreeSet<[LatticePoint; 2]> = by_tile
                .get(&id)
                .into_iter()
                .flatten()
                .flat_map(|points| points.array_windows().copied().collect::<Vec<_>>())
                .collect();
            assert!(found.is_superset(&needed), "{id}: {} of {}", found.len(), needed.len());
        }
    }
}

#[test]
fn junctions_stay_and_coarse_levels_have_fewer_points() {
    let levels = levels();
    let lengths = lengths(&levels);
    let (splitting, boundary) = (splitting(&levels, &lengths), wave(&levels));
    let lines: Vec<Vec<LatticePoint>> =
        levels.numbers().map(|level| splitting.line(&part(&boundary), level).points).collect();
    let counts: Vec<usize> = lines.iter().map(Vec::len).collect();
    assert!(counts[0] < counts[1] && counts[1] < counts[2], "{counts:?}");
    for (level, line) in (0..).zip(&lines) {
        let half = splitting.plan.step(level) / 2 + 1;
        for &index in &boundary.fixed {
            let junction = boundary.points[index as usize];
            let is_near = |point: &LatticePoint| {
                (point.u - junction.u).abs() <= half && (point.v - junction.v).abs() <= half
            };
            assert!(line.iter().any(is_near), "{index} on level {level}");
        }
    }
}

#[test]
fn small_units_are_stored_where_cells_are_small() {
    let frame = GridFrame::new([0.0, 0.0], 60.0, NodeIndex { i: -512, j: 512 }, 2).unwrap();
    let table = FrcTable::new("one", vec![("primary".into(), 0)], Vec::new(), 8).unwrap();
    let settings =
        RoadSettings { table, filter: ClassFilter::all(), simplify_cells: 0.25, spans: false };
    let levels = Levels::new(frame, 1.0, &settings, 1.0);
    let lengths = lengths(&levels);
    let splitting = splitting(&levels, &lengths);
    let shown = |id: &str| -> Vec<u8> { splitting.plan.levels_of(class(id)).collect() };
    // The levels have cells of 240, 120 and 60 m.
    assert_eq!(shown("admin-2"), [0, 1, 2]);
    assert_eq!(shown("admin-6"), [0, 1, 2]);
    assert_eq!(shown("admin-8"), [2]);
    assert_eq!(shown("protected"), [2]);
}

/// The part of the wave in a square around the middle: cut at the outline on every level, with
/// nothing outside.
#[test]
fn boundaries_end_at_the_outline_of_a_polygon() {
    let levels = levels();
    let corner = |[x, y]: [f64; 2]| levels.frame().snap([x, y]).unwrap();
    let square = [[-1000.0, -2000.0], [1000.0, -2000.0], [1000.0, 2000.0], [-1000.0, 2000.0]];
    let region = LatticeRegion::new(&[vec![square.map(corner).to_vec()]]).unwrap();
    let bounds = region.bounds();
    let boundary = wave(&levels);
    let lengths = lengths(&levels);
    let mut splitting = splitting(&levels, &lengths);
    splitting.plan.polygon = Some(&region);
    let parts = splitting.split(&boundary);
    for level in 0..=2 {
        let points =
            parts.iter().filter(|(id, _)| id.z() == level).flat_map(|(_, part)| &part.points);
        let own = LatticeBounds::around(&points.copied().collect::<Vec<_>>()).unwrap();
        let step = splitting.plan.step(level);
        assert!(
            (own.min.u - bounds.min.u).abs() <= step && (own.max.u - bounds.max.u).abs() <= step
        );
    }
}

/// A piece of a bridge has the positions of its points along the whole line, on all levels, with
/// and without a polygon that cuts the line.
#[test]
fn pieces_of_bridges_know_where_they_are_along_their_way() {
    let levels = levels();
    let lengths = lengths(&levels);
    let mut splitting = splitting(&levels, &lengths);
    let bridge = LayerLine { structure: Structure::Bridge, ..wave(&levels) };
    let line = Polyline::new(bridge.points.clone()).unwrap();
    let all_um: u64 = lengths.projected_segments_um(&line).iter().sum();
    let corner = |[u, v]: [i64; 2]| LatticePoint::new(u, v);
    let [low, high] = [bridge.points[100], bridge.points[400]].map(|at| at.u);
    let far = 1 << 40;
    let square = [[low, -far], [high, -far], [high, far], [low, far]];
    let region = LatticeRegion::new(&[vec![square.map(corner).to_vec()]]).unwrap();
    for polygon in [None, Some(&region)] {
        splitting.plan.polygon = polygon;
        for (id, LevelPart { points, along_um }) in splitting.split(&bridge) {
            assert_eq!(points.len(), along_um.len());
            assert!(along_um.is_sorted() && along_um.last().is_some_and(|last| *last <= all_um));
            // A point of the wave is as far along as its east coordinate says, up to the steps
            // of the level.
            let step = splitting.plan.step(id.z());
            for (point, along_um) in points.iter().zip(&along_um) {
                let before = bridge.points.partition_point(|other| other.u + step < point.u);
                let after = bridge.points.partition_point(|other| other.u <= point.u + step);
                let along = |count: usize| -> u64 {
                    let before = &bridge.points[..count.clamp(2, bridge.points.len())];
                    let before = Polyline::new(before.to_vec()).unwrap();
                    lengths.projected_segments_um(&before).iter().sum()
                };
                let least_um = if before < 2 { 0 } else { along(before) };
                let most_um = along(after + 1);
                assert!((least_um..=most_um).contains(along_um), "{id}: {point:?} at {along_um}");
            }
        }
    }
}
