//! Roads over voids and outside the data.

use corniche_geom::NodeIndex;
use corniche_tin::{Placement, Surface};

use super::{
    ANCHORS, CORNER, MAX_ERROR_M,
    counting::{check_ground, filled},
    in_square, raster,
    support::{
        Built, CELL_M, Options, Raster, TILE, build_files,
        extract::{self, StraightRoad},
        terrain::bits,
    },
};

/// Whether the cell at a column and row of the raster has ground.
fn has_ground(truth: &Raster, column: i64, row: i64) -> bool {
    let node = |c, r| NodeIndex { i: truth.west + c, j: truth.north - r };
    [(0, 0), (1, 0), (0, 1), (1, 1)]
        .iter()
        .all(|&(c, r)| truth.height_m(node(column + c, row + r)).is_some())
}

/// Roads along the middle of rows and columns of cells: exactly their length on cells with ground
/// is kept; the rest is counted as lost; and no vertex and no middle of an edge is in the air, on
/// any level.
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
    // Slanting roads: one that starts and ends in a void, and one wholly in it.
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

    // Coordinates of an extract are multiples of 1e-7 degrees: a centimetre at each end.
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

/// Plan length of a way's GEO lines on the finest level.
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

/// Asserts that every vertex, and the middle of every edge, of every GEO line is on a cell of its
/// level that has ground; returns how many were checked.
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
            // On an edge, either cell suffices.
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
