//! Voids through the whole pipeline: no spike, no wall, no road in the air, and every node with data that a TIN does
//! not cover beside a void or the data's edge. All of it by counting nodes and cells of the raster that was written.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

mod support;

use corniche_geom::{HeightGrid, NodeIndex, TileId};
use corniche_pipeline::BuildError;
use corniche_tin::{Placement, Surface, Tin, check_covers_ground};
use support::{
    Built, CELL_M, Options, Raster, TILE, build_files, build_raster,
    extract::{self, StraightRoad},
    terrain::{bits, noise, waves},
};

const SIDE: usize = 601;
/// Where four tiles meet, and the middle of a border and of a tile: columns and rows of the rasters.
const CORNER: i64 = 300;
const ANCHORS: [[i64; 2]; 3] =
    [[CORNER, CORNER], [CORNER, CORNER + 128], [CORNER - 120, CORNER + 120]];
const MAX_ERROR_M: f64 = 4.0;

/// A hilly raster with voids, the tiles' common corner at [`CORNER`].
fn raster(is_void: &dyn Fn(i64, i64) -> bool) -> Raster {
    Raster::new([SIDE, SIDE], [TILE - CORNER, TILE - CORNER], |column, row| {
        if is_void(column, row) {
            return f32::NAN;
        }
        500.0 + 200.0 * waves(column, row) + 2.0 * noise(column, row)
    })
}

/// What was written, and the voids filled by the rule: data within `reach` in each of the eight directions.
fn filled(raster: &Raster, reach: i64) -> Raster {
    let at = |column: i64, row: i64| {
        raster.height_m(NodeIndex { i: raster.west + column, j: raster.north - row })
    };
    let fill = |column: i64, row: i64| -> Option<f32> {
        let (mut sum, mut weights) = (0.0, 0.0);
        for (east, south) in [(0, 1), (1, 0), (1, 1), (1, -1), (0, -1), (-1, 0), (-1, -1), (-1, 1)]
        {
            let found = (1..=reach)
                .find_map(|cells| Some((cells, at(column + cells * east, row + cells * south)?)));
            let (cells, height_m) = found?;
            let weight = 1.0 / (cells as f64 * ((east * east + south * south) as f64).sqrt());
            sum += weight * f64::from(height_m);
            weights += weight;
        }
        Some((sum / weights) as f32)
    };
    let mut heights_m = raster.heights_m.clone();
    for (index, height_m) in
        heights_m.iter_mut().enumerate().filter(|(_, height_m)| height_m.is_nan())
    {
        let (column, row) = (index % raster.columns, index / raster.columns);
        *height_m = fill(column as i64, row as i64).unwrap_or(f32::NAN);
    }
    Raster { heights_m, ..*raster }
}

/// Builds and compares with what counting says.
fn check(name: &str, is_void: &dyn Fn(i64, i64) -> bool, fill_voids: u32) {
    let raster = raster(is_void);
    let options = Options { fill_voids, ..Options::plain(MAX_ERROR_M) };
    let built = build_raster(&raster, options).unwrap_or_else(|error| panic!("{name}: {error}"));
    check_ground(name, &built, &filled(&raster, i64::from(fill_voids)), &raster);
}

fn check_ground(name: &str, built: &Built, truth: &Raster, source: &Raster) {
    let count =
        |raster: &Raster| raster.heights_m.iter().filter(|height_m| !height_m.is_nan()).count();
    let samples = built.manifest.counts.samples;
    let counted = [samples.with_data, samples.filled, samples.void];
    let filled = count(truth) - count(source);
    let void = truth.heights_m.len() - count(truth);
    assert_eq!(counted, [count(source), filled, void].map(|nodes| nodes as u64), "{name}");

    for level in 0..=built.frame().max_level() {
        let mut uncovered = 0;
        for (x, y) in (0..1_u32 << level).flat_map(|x| (0..1_u32 << level).map(move |y| (x, y))) {
            uncovered += check_tile(name, built, truth, TileId::new(level, x, y).unwrap());
        }
        let said = built.manifest.levels[usize::from(level)].uncovered_nodes;
        assert_eq!(said, uncovered, "{name}: uncovered nodes of level {level}");
    }
}

/// Checks a tile, there or not; gives its nodes with data that no cell of its level covers, those on the east and
/// south border left to the next tile.
fn check_tile(name: &str, built: &Built, truth: &Raster, id: TileId) -> u64 {
    let frame = built.frame();
    let (corner, stride) = (frame.tile_corner(id), frame.stride(id.z()));
    let node = |column: i64, row: i64| NodeIndex {
        i: corner.i + column * stride,
        j: corner.j - row * stride,
    };
    let side = TILE as usize + 3;
    let level_heights = HeightGrid::from_fn(side, side, |column, row| {
        truth.height_m(node(column as i64 - 1, row as i64 - 1)).unwrap_or(f32::NAN)
    });
    let none = Tin::default();
    let ground = built.ground(id);
    let tin = ground.map_or(&none, |ground| &ground.tin);
    tin.check_invariants();
    // No wall and no hole: in plan the TIN is the ground cells of its level, to the last edge.
    check_covers_ground(tin, &level_heights);
    assert_eq!(ground.is_none(), tin.is_empty(), "{name}: {id}");
    // No spike: a vertex is as high as the raster there.
    let quantum_m = built.quantum_m();
    for (vertex, node) in tin.vertices().iter().zip(built.nodes(id, tin)) {
        let height_m = f64::from(truth.height_m(node).expect("a vertex lies where data are"));
        let off_m = (f64::from(vertex.height_q) * quantum_m - height_m).abs();
        assert!(off_m <= quantum_m / 2.0, "{name}: {id} {vertex:?} is {off_m} m off");
    }
    check_error(name, built, truth, id);
    uncovered_nodes(name, truth, &level_heights, corner, stride)
}

/// The stored error is not below the true one, node by node and triangle by triangle.
fn check_error(name: &str, built: &Built, truth: &Raster, id: TileId) {
    let Some(ground) = built.ground(id) else { return };
    let nodes = built.nodes(id, &ground.tin);
    let mut true_m = 0.0_f64;
    for corners in ground.tin.triangles() {
        let at = corners.map(|corner| nodes[corner as usize]);
        let [a, b, c] = at.map(|node| [node.i as f64, node.j as f64]);
        let heights_m = corners.map(|corner| {
            f64::from(ground.tin.vertices()[corner as usize].height_q) * built.quantum_m()
        });
        let (i, j) = (at.map(|node| node.i), at.map(|node| node.j));
        for i in *i.iter().min().unwrap()..=*i.iter().max().unwrap() {
            for j in *j.iter().min().unwrap()..=*j.iter().max().unwrap() {
                let weights = corniche_geom::barycentric([i as f64, j as f64], a, b, c);
                if weights.iter().any(|&weight| weight < -1e-9) {
                    continue;
                }
                let Some(height_m) = truth.height_m(NodeIndex { i, j }) else { continue };
                let tin_m: f64 = weights.iter().zip(heights_m).map(|(weight, h)| weight * h).sum();
                true_m = true_m.max((tin_m - f64::from(height_m)).abs());
            }
        }
    }
    let stored_m = ground.geometric_error_m;
    assert!(stored_m >= true_m - 1e-6, "{name}: {id} stores {stored_m} m, is {true_m} m off");
    if id.z() == built.frame().max_level() {
        assert!(true_m <= MAX_ERROR_M + 1e-6, "{name}: {id} is {true_m} m off");
    }
}

/// Counts nodes with data outside all ground cells of a tile, each within one cell of the level from a void.
fn uncovered_nodes(
    name: &str,
    truth: &Raster,
    level_heights: &HeightGrid,
    corner: NodeIndex,
    stride: i64,
) -> u64 {
    let mut uncovered = 0;
    // Beyond the raster there is nothing to count.
    let columns = (truth.west - corner.i).max(0)
        ..(truth.west + truth.columns as i64 - corner.i).min(TILE * stride);
    let rows = (corner.j - truth.north).max(0)
        ..(corner.j - truth.north + truth.rows as i64).min(TILE * stride);
    for row in rows {
        for column in columns.clone() {
            let at = |column: i64, row: i64| NodeIndex { i: corner.i + column, j: corner.j - row };
            if truth.height_m(at(column, row)).is_none() {
                continue;
            }
            // Cells of the level that hold the node, edges included: one, two or four; in the halo too, where
            // the cells of the tiles west and north lie.
            let cells = |at: i64| {
                let on_edge = i64::from(at % stride == 0);
                at / stride + 1 - on_edge..=at / stride + 1
            };
            let covered = cells(row).any(|r| {
                cells(column).any(|c| level_heights.cell_has_ground(c as usize, r as usize))
            });
            // A tile is measured by its own TIN alone.
            let own = cells(row).any(|r| {
                r > 0
                    && cells(column)
                        .any(|c| c > 0 && level_heights.cell_has_ground(c as usize, r as usize))
            });
            if own {
                continue;
            }
            uncovered += 1;
            if covered {
                continue;
            }
            let near_void = (-stride..=stride).any(|south| {
                (-stride..=stride)
                    .any(|east| truth.height_m(at(column + east, row + south)).is_none())
            });
            assert!(near_void, "{name}: a node far from any void is bare at stride {stride}");
        }
    }
    uncovered
}

/// Whether a node lies in a square of `side` nodes around an anchor.
fn in_square([column, row]: [i64; 2], [east, south]: [i64; 2], side: i64) -> bool {
    let from = side / 2;
    (0..side).contains(&(column - east + from)) && (0..side).contains(&(row - south + from))
}

#[test]
fn holes_of_every_size_on_corners_borders_and_inside() {
    for side in [1, 2, 3, 17, 65] {
        let hole = |c, r| ANCHORS.iter().any(|&anchor| in_square([c, r], anchor, side));
        check(&format!("holes of {side}"), &hole, 0);
        check(&format!("holes of {side}, filled within 8"), &hole, 8);
    }
}

#[test]
fn islands_of_every_size_on_corners_borders_and_inside() {
    for side in [2, 3, 17, 65] {
        let sea = |c, r| !ANCHORS.iter().any(|&anchor| in_square([c, r], anchor, side));
        check(&format!("islands of {side}"), &sea, 0);
        check(&format!("islands of {side}, filled within 8"), &sea, 8);
    }
    // One node is no ground, but beside an island it does no harm.
    let rock = |c, r| !(in_square([c, r], ANCHORS[0], 9) || [c, r] == ANCHORS[1]);
    check("a rock beside an island", &rock, 0);
}

#[test]
fn holes_and_islands_as_large_as_tiles() {
    for side in [255, 256, 257, 258, 400] {
        // From the corner of tiles to the east and south: a whole tile, one node less, one more.
        let square =
            |c: i64, r: i64| (0..side).contains(&(c - CORNER)) && (0..side).contains(&(r - CORNER));
        check(&format!("a hole of {side}"), &square, 8);
        check(&format!("an island of {side}"), &|c, r| !square(c, r), 0);
    }
}

#[test]
fn checkerboards_stripes_and_scattered_nodes() {
    for side in [2, 3, 7, 128] {
        let board = |c: i64, r: i64| (c / side + r / side) % 2 == 0;
        check(&format!("a board of {side}"), &board, 0);
        check(&format!("a board of {side}, filled within 5"), &board, 5);
    }
    check("single columns void", &|c, _| c % 16 == 12, 0);
    check("pairs of columns with data", &|c, _| c % 3 == 2, 0);
    check("every column of a border void", &|c, _| c == CORNER, 0);
    check("all but two columns beside a border void", &|c, _| c != CORNER && c != CORNER + 1, 0);
    check("scattered", &|c, r| bits(c, r, 1).is_multiple_of(50), 0);
    check("scattered, filled within 3", &|c, r| bits(c, r, 1).is_multiple_of(3), 3);
}

#[test]
fn data_that_end_across_the_grid() {
    for angle_deg in [45.0_f64, 17.0, 1.5] {
        let (sin, cos) = angle_deg.to_radians().sin_cos();
        let outside = |c: i64, r: i64| {
            let (x, y) = ((c - CORNER) as f64, (r - CORNER) as f64);
            (x * cos + y * sin).abs() > 200.0 || (y * cos - x * sin).abs() > 190.0
        };
        check(&format!("a square turned by {angle_deg}"), &outside, 0);
        check(&format!("a square turned by {angle_deg}, filled within 32"), &outside, 32);
    }
    let disc = |c: i64, r: i64| (c - CORNER).pow(2) + (r - CORNER).pow(2) > 280 * 280;
    check("a disc", &disc, 32);
}

/// Every second node: along the diagonals through a void there is no data, so none is filled, and no cell is whole.
#[test]
fn a_board_of_single_nodes_has_no_ground() {
    for fill_voids in [0, 32] {
        let raster = raster(&|c, r| (c + r) % 2 == 0);
        let options = Options { fill_voids, ..Options::plain(MAX_ERROR_M) };
        let refused = build_raster(&raster, options).err().unwrap();
        let data = (SIDE * SIDE / 2) as u64;
        assert!(matches!(refused, BuildError::NoCell { nodes, .. } if nodes == data), "{refused}");
        assert!(
            refused.is_unusable_input() && refused.to_string().contains("dem.tif"),
            "{refused}"
        );
    }
    let refused = build_raster(&raster(&|_, _| true), Options::plain(MAX_ERROR_M)).err().unwrap();
    assert!(matches!(refused, BuildError::NoHeights { .. }), "{refused}");
}

/// A square of degrees in a projected grid: its edges run across cells, and nodes lie between samples.
#[test]
fn a_square_of_degrees_ends_where_its_samples_end() {
    const SAMPLES: usize = 360;
    const STEP_DEG: f64 = 1.0 / 1200.0;
    let [west_deg, north_deg] = [10.9, 60.2];
    let height_m = |[lon_deg, lat_deg]: [f64; 2]| {
        300.0 + 150.0 * (lon_deg * 90.0).sin() + 150.0 * (lat_deg * 120.0).cos()
    };
    let folder = tempfile::tempdir().unwrap();
    let dem = folder.path().join("square.tif");
    support::write_degrees(&dem, SAMPLES, [west_deg, north_deg], STEP_DEG, height_m);
    let options = Options { crs: Some("utm"), ..Options::plain(5.0) };
    let built = build_files(&dem, None, options).unwrap();
    let frame = built.frame();
    let mut vertices = 0;
    for (id, ground) in built.grounds() {
        ground.tin.check_invariants();
        let nodes = built.nodes(id, &ground.tin);
        let positions: Vec<[f64; 2]> =
            nodes.iter().map(|node| [frame.x_m(node.i), frame.y_m(node.j)]).collect();
        let degrees = extract::utm_to_degrees(&positions);
        for (vertex, at) in ground.tin.vertices().iter().zip(degrees) {
            let from_edge = [at[0] - west_deg, north_deg - at[1]].map(|deg| deg / STEP_DEG);
            let last = (SAMPLES - 1) as f64;
            // No ground beyond the outermost samples; a thousandth of a sample for the way back from the grid.
            assert!(
                from_edge.iter().all(|at| (-1e-3..=last + 1e-3).contains(at)),
                "{id} {from_edge:?}"
            );
            // Within what the four samples around it say: a wave of this length bends by less than 1 m between two.
            let off_m = (f64::from(vertex.height_q) * built.quantum_m() - height_m(at)).abs();
            assert!(off_m < 1.0, "{id}: a vertex {off_m} m off at {at:?}");
            vertices += 1;
        }
    }
    assert!(vertices > 1000);
    // The whole square is ground, but for cells that its edge cuts: one cell around it.
    let finest = built.grounds().filter(|(id, _)| id.z() == frame.max_level());
    let doubled: i64 = finest.map(|(_, ground)| doubled_area(&ground.tin)).sum();
    let ground_m2 = doubled as f64 / 2.0 * frame.cell().east_m * frame.cell().north_m;
    let side_m = (SAMPLES - 1) as f64 * STEP_DEG * 111_400.0;
    let square_m2 = side_m * side_m * f64::to_radians(60.05).cos();
    let rim_m2 = 4.0 * side_m * 2.0 * frame.cell().shorter_m();
    assert!(
        (square_m2 - rim_m2..square_m2 * 1.01).contains(&ground_m2),
        "{ground_m2} of {square_m2} m²"
    );
}

/// Twice the area of a TIN in cells of its level.
fn doubled_area(tin: &Tin) -> i64 {
    let at = |vertex: u32| {
        let vertex = tin.vertices()[vertex as usize];
        [i64::from(vertex.column), i64::from(vertex.row)]
    };
    let areas = tin.triangles().iter().map(|corners| {
        let [a, b, c] = corners.map(at);
        ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs()
    });
    areas.sum()
}

/// Whether the cell at a column and row of the raster has ground.
fn has_ground(truth: &Raster, column: i64, row: i64) -> bool {
    let node = |c, r| NodeIndex { i: truth.west + c, j: truth.north - r };
    [(0, 0), (1, 0), (0, 1), (1, 1)]
        .iter()
        .all(|&(c, r)| truth.height_m(node(column + c, row + r)).is_some())
}

/// Roads along the middle of rows and columns of cells: what is kept of them is, exactly, what lies on cells with
/// ground; the rest is counted as lost; and no vertex and no middle of an edge is in the air, on any level.
#[test]
fn roads_end_where_the_ground_ends() {
    let is_void = |c: i64, r: i64| {
        in_square([c, r], ANCHORS[0], 40)
            || in_square([c, r], ANCHORS[1], 9)
            || bits(c.div_euclid(13), r.div_euclid(11), 1).is_multiple_of(20)
            || c + r > 1000
    };
    let raster = raster(&is_void);
    let truth = filled(&raster, 4);
    let mut roads = Vec::new();
    for k in [3, 100, CORNER - 1, CORNER, CORNER + 1, CORNER + 128, 555] {
        let across = k as f64 + 0.5;
        roads.push(StraightRoad { from: [2.25, across], to: [597.5, across] });
        roads.push(StraightRoad { from: [across, 590.75], to: [across, 8.5] });
    }
    let along = roads.len();
    // Slanting ones, one that begins and ends in a void, and one wholly in it.
    roads.push(StraightRoad { from: [10.0, 10.0], to: [590.0, 590.0] });
    roads.push(StraightRoad { from: [20.0, 580.0], to: [570.0, 33.0] });
    roads.push(StraightRoad { from: [300.5, 300.5], to: [590.0, 580.0] });
    roads.push(StraightRoad { from: [595.0, 590.0], to: [585.0, 595.0] });

    let folder = tempfile::tempdir().unwrap();
    let [dem, osm] = ["dem.tif", "roads.osm.pbf"].map(|name| folder.path().join(name));
    raster.write(&dem);
    extract::write(&osm, &raster, &roads);
    let options = Options { fill_voids: 4, ..Options::plain(MAX_ERROR_M) };
    let built = build_files(&dem, Some(&osm), options).unwrap();
    check_ground("with roads", &built, &truth, &raster);

    // Coordinates of an extract are whole 1e-7 degrees: a centimetre at each end.
    let slack_m = 0.05;
    for (way, road) in (1_i64..).zip(&roads[..along]) {
        let kept_m = kept_length_m(&built, way);
        let expected_m = ground_beneath(&truth, road) * CELL_M;
        assert!((kept_m - expected_m).abs() < slack_m, "way {way}: {kept_m} m, not {expected_m} m");
    }
    let counts = &built.manifest.counts;
    assert_eq!((counts.roads_in, counts.roads_kept), (roads.len() as u64, roads.len() as u64 - 1));
    let lost_um: u64 = counts.roads_lost.iter().map(|loss| loss.length_um).sum();
    assert!(lost_um > 1_000_000_000 && counts.roads_lost.iter().any(|loss| loss.roads == 1));
    assert_eq!(counts.roads_in_um, counts.roads_kept_um + lost_um);
    let kept_m: f64 = (1..=roads.len() as i64).map(|way| kept_length_m(&built, way)).sum();
    let true_m = counts.roads_kept_um as f64 / 1e6;
    let scaled_m = true_m * built.manifest.point_scale;
    assert!((kept_m - scaled_m).abs() < 1e-4 * kept_m, "{kept_m} m lie in the tiles, {scaled_m}");
    assert!(check_roads_on_ground(&built, &truth) > 1000);
}

/// Cells with ground beneath a road along the middle of a row or a column.
fn ground_beneath(truth: &Raster, road: &StraightRoad) -> f64 {
    let axis = usize::from(road.from[0].to_bits() == road.to[0].to_bits());
    let (low, high) = (road.from[axis].min(road.to[axis]), road.from[axis].max(road.to[axis]));
    let across = road.from[1 - axis].floor() as i64;
    (low.floor() as i64..high.ceil() as i64)
        .filter(|&cell| {
            if axis == 0 {
                has_ground(truth, cell, across)
            } else {
                has_ground(truth, across, cell)
            }
        })
        .map(|cell| high.min(cell as f64 + 1.0) - low.max(cell as f64))
        .sum()
}

/// Plan length of a way's GEO lines at the finest level.
fn kept_length_m(built: &Built, way_id: i64) -> f64 {
    let frame = built.frame();
    let mut steps = 0.0;
    for (id, ground) in built.grounds().filter(|(id, _)| id.z() == frame.max_level()) {
        let placement = Placement::of_tile(frame, id, built.quantum_m());
        let surface = Surface::new(&ground.tin, placement);
        for road in built.tiles[&id].roads_geo.iter().filter(|road| road.way_id == way_id) {
            let line = corniche_drape::positions(&road.line, &surface).unwrap();
            let lengths = line.windows(2).map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1]));
            steps += lengths.sum::<f64>();
        }
    }
    steps * frame.lattice_step_m()
}

/// Every vertex, and the middle of every edge, of every GEO line lies on a cell of its level that has ground; gives
/// how many were looked at.
fn check_roads_on_ground(built: &Built, truth: &Raster) -> usize {
    let frame = built.frame();
    let mut looked_at = 0;
    for (id, ground) in built.grounds() {
        let placement = Placement::of_tile(frame, id, built.quantum_m());
        let surface = Surface::new(&ground.tin, placement);
        let (corner, stride) = (frame.tile_corner(id), frame.stride(id.z()));
        let on_ground = |at: [f64; 2]| {
            let [east, north] = placement.node_steps.map(|steps| steps as f64);
            let place = [
                (at[0] - placement.corner.u as f64) / east,
                (placement.corner.v as f64 - at[1]) / north,
            ];
            // On an edge either cell will do.
            let cells = |at: f64| [(at - 1e-6).floor() as i64, (at + 1e-6).floor() as i64];
            cells(place[1]).iter().any(|&row| {
                cells(place[0]).iter().any(|&column| {
                    let inside = (0..TILE).contains(&column) && (0..TILE).contains(&row);
                    inside
                        && [(0, 0), (1, 0), (0, 1), (1, 1)].iter().all(|&(c, r)| {
                            let (i, j) = ((column + c) * stride, (row + r) * stride);
                            truth.height_m(NodeIndex { i: corner.i + i, j: corner.j - j }).is_some()
                        })
                })
            })
        };
        for road in &built.tiles[&id].roads_geo {
            let line = corniche_drape::positions(&road.line, &surface).unwrap();
            let middles = line.windows(2).map(|p| [0, 1].map(|k| f64::midpoint(p[0][k], p[1][k])));
            for at in line.iter().map(|p| [p[0], p[1]]).chain(middles) {
                assert!(on_ground(at), "way {} is in the air in {id} at {at:?}", road.way_id);
                looked_at += 1;
            }
        }
    }
    looked_at
}
