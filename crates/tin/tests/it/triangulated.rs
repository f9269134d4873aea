//! Every node of a tile is within the tolerance of its TIN, and simple ground has few triangles.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::collections::BTreeSet;

use corniche_geom::HeightGrid;
use corniche_testing::{check_covers_ground, check_tin, srtm_heights};
use corniche_tin::{Tin, TinSpec, TinVertex, TriangulateError, height_quantum_m, triangulate};
use proptest::prelude::*;

const SPEC: TinSpec = TinSpec { max_error_m: 2.0, quantum_m: 1.0 / 16.0 };
const GAP: f32 = f32::NAN;

/// Triangulates and checks all promises of a TIN.
fn check(heights: &HeightGrid, spec: TinSpec) -> Tin {
    let tin = triangulate(heights, spec).unwrap();
    check_tin(&tin);
    check_covers_ground(&tin, heights);
    check_error(&tin, heights, spec);
    tin
}

/// Checks that every node on the ground is within the tolerance: by barycentric coordinates, node
/// against triangle, without the row walk of the tested code.
fn check_error(tin: &Tin, heights: &HeightGrid, spec: TinSpec) {
    let mut reached = BTreeSet::new();
    for triangle in tin.triangles() {
        let corners = triangle.map(|vertex| tin.vertices()[vertex as usize]);
        let [a, b, c] = corners.map(|v| [f64::from(v.column), f64::from(v.row)]);
        let (columns, rows) = (corners.map(|v| v.column), corners.map(|v| v.row));
        for row in *rows.iter().min().unwrap()..=*rows.iter().max().unwrap() {
            for column in *columns.iter().min().unwrap()..=*columns.iter().max().unwrap() {
                let weights =
                    corniche_geom::barycentric([f64::from(column), f64::from(row)], a, b, c);
                if weights.iter().any(|&weight| weight < -1e-9) {
                    continue;
                }
                let tin_m: f64 = weights
                    .iter()
                    .zip(corners)
                    .map(|(w, v)| w * f64::from(v.height_q) * spec.quantum_m)
                    .sum();
                let height_m =
                    heights.height(usize::from(column) + 1, usize::from(row) + 1).unwrap();
                let error_m = (f64::from(height_m) - tin_m).abs();
                assert!(
                    error_m <= spec.max_error_m + 1e-6,
                    "{error_m} m off at column {column}, row {row}"
                );
                reached.insert((row, column));
            }
        }
    }
    let on_ground = |c: usize, r: usize| {
        let cells = [(c, r), (c + 1, r), (c, r + 1), (c + 1, r + 1)];
        cells.into_iter().any(|(c, r)| {
            (1..heights.columns() - 2).contains(&c)
                && (1..heights.rows() - 2).contains(&r)
                && heights.cell_has_ground(c, r)
        })
    };
    let (columns, rows) = (heights.columns() - 2, heights.rows() - 2);
    let nodes = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    assert_eq!(reached.len(), nodes.filter(|&(c, r)| on_ground(c, r)).count(), "nodes covered");
}

/// A tile drawn in characters: `#` is a height of 5 m, any other character is a gap; a halo of gaps
/// is added.
fn drawn(rows: &[&str]) -> HeightGrid {
    HeightGrid::from_fn(rows[0].len() + 2, rows.len() + 2, |c, r| {
        let inside = (1..=rows[0].len()).contains(&c) && (1..=rows.len()).contains(&r);
        if inside && rows[r - 1].as_bytes()[c - 1] == b'#' { 5.0 } else { GAP }
    })
}

fn size(tin: &Tin) -> (usize, usize) {
    (tin.vertices().len(), tin.triangles().len())
}

#[test]
fn level_and_sloping_planes_have_two_triangles() {
    assert_eq!(size(&check(&HeightGrid::from_fn(259, 259, |_, _| 812.3), SPEC)), (4, 2));
    assert_eq!(
        size(&check(&HeightGrid::from_fn(259, 131, |c, r| (3 * c + r) as f32), SPEC)),
        (4, 2)
    );
}

#[test]
fn a_ridge_needs_its_ends_only() {
    // A roof with a horizontal ridge along column 16: two planes.
    let tin =
        check(&HeightGrid::from_fn(35, 35, |c, _| 160.0 - 10.0 * (c as f32 - 17.0).abs()), SPEC);
    assert_eq!(size(&tin), (6, 4));
}

#[test]
fn a_saddle_is_met_within_the_tolerance() {
    let saddle = HeightGrid::from_fn(67, 67, |c, r| (c as f32 - 33.0) * (r as f32 - 33.0) / 8.0);
    let (coarse, fine) =
        (check(&saddle, SPEC), check(&saddle, TinSpec { max_error_m: 0.5, quantum_m: 1.0 / 64.0 }));
    // The error of a saddle's triangles falls with the square of their size: a quarter of the error
    // takes four times as many triangles.
    let growth = fine.triangles().len() as f64 / coarse.triangles().len() as f64;
    assert!((2.5..6.0).contains(&growth), "{growth}");
}

#[test]
fn a_step_keeps_both_its_edges() {
    let tin = check(&HeightGrid::from_fn(35, 35, |c, _| if c < 18 { 0.0 } else { 500.0 }), SPEC);
    assert_eq!(size(&tin), (8, 6));
}

#[test]
fn a_spike_becomes_a_vertex() {
    let tin = check(
        &HeightGrid::from_fn(35, 35, |c, r| if (c, r) == (11, 21) { 90.0 } else { 0.0 }),
        SPEC,
    );
    assert!(tin.vertices().contains(&TinVertex { row: 20, column: 10, height_q: 90 * 16 }));
}

#[test]
fn without_ground_there_is_nothing() {
    assert_eq!(check(&HeightGrid::from_fn(20, 20, |_, _| GAP), SPEC), Tin::default());
    // Heights, but no cell with four of them.
    assert_eq!(
        check(&HeightGrid::from_fn(20, 20, |c, r| if (c + r) % 2 == 0 { 1.0 } else { GAP }), SPEC),
        Tin::default()
    );
    // Ground only in the halo.
    assert_eq!(
        check(&HeightGrid::from_fn(20, 20, |c, _| if c < 2 { 1.0 } else { GAP }), SPEC),
        Tin::default()
    );
}

#[test]
fn ground_in_awkward_shapes_is_covered_exactly() {
    // A single cell.
    assert_eq!(size(&check(&drawn(&["......", ".##...", ".##...", "......"]), SPEC)), (4, 2));
    // Two cells that touch in a point; the shared node is one vertex.
    assert_eq!(size(&check(&drawn(&["....#", ".##..", ".###.", "..##.", "....."]), SPEC)), (7, 4));
    // Two voids that touch in a point, inside the tile.
    check(
        &drawn(&[
            "########", "########", "##.#####", "########", "####.###", "########", "########",
        ]),
        SPEC,
    );
    // Corridors of one cell around voids, even at the border.
    check(
        &drawn(&[
            "##########",
            "##########",
            "##......##",
            "##.####.##",
            "##.####.##",
            "##......##",
            "##########",
            "##########",
        ]),
        SPEC,
    );
    // Ground only on the border.
    check(&drawn(&["##....", "##....", "##..##", "##..##"]), SPEC);
    // An island of one cell in a lake, in an island.
    let island =
        ["..........", ".########.", ".########.", ".##....##.", ".##.##.##.", ".##.##.##."];
    let shore = [".##....##.", ".########.", ".########.", ".........."];
    check(&drawn(&[&island[..], &shore[..]].concat()), SPEC);
}

#[test]
fn refuses_what_makes_no_sense() {
    let level = HeightGrid::from_fn(10, 10, |_, _| 1.0);
    for (max_error_m, quantum_m) in
        [(0.0, 0.0), (1.0, 2.0), (f64::NAN, 0.1), (1.0, f64::NAN), (f64::INFINITY, 1.0)]
    {
        let result = triangulate(&level, TinSpec { max_error_m, quantum_m });
        assert!(matches!(result, Err(TriangulateError::Spec { .. })), "{max_error_m} {quantum_m}");
    }
    let thin = HeightGrid::from_fn(3, 10, |_, _| 1.0);
    assert_eq!(triangulate(&thin, SPEC), Err(TriangulateError::Size { columns: 3, rows: 10 }));
    let high = HeightGrid::from_fn(10, 10, |c, _| if c == 4 { 3.4e38 } else { 0.0 });
    assert!(matches!(triangulate(&high, SPEC), Err(TriangulateError::Height { .. })));
}

#[test]
fn quantum_is_a_power_of_two_below_a_thirty_second() {
    for (max_error_m, quantum_m) in
        [(32.0, 1.0), (31.9, 0.5), (7.5, 0.125), (63.0, 1.0), (5.0, 0.125)]
    {
        assert_eq!(
            height_quantum_m(max_error_m).to_bits(),
            f64::to_bits(quantum_m),
            "{max_error_m}"
        );
    }
    assert!([0.0, -1.0, f64::NAN].iter().all(|&bad| height_quantum_m(bad) == 0.0));
}

#[test]
fn real_tile_has_known_counts() {
    let Some(heights) = srtm_heights("liechtenstein/N47E010.hgt", 600, 400) else { return };
    let counts = [5.0, 20.0, 80.0].map(|max_error_m| {
        size(&check(&heights, TinSpec { max_error_m, quantum_m: height_quantum_m(max_error_m) }))
    });
    assert_eq!(counts, GOLDEN);
}

/// Vertices and triangles of a tile of the Alps with gaps, at 5, 20 and 80 m.
const GOLDEN: [(usize, usize); 3] = [(22201, 43656), (5569, 10730), (1026, 1820)];

/// Terrain from flat to cliffs, with gaps from none to most nodes.
fn terrain(columns: usize, rows: usize) -> impl Strategy<Value = HeightGrid> {
    let relief = prop_oneof![Just(0.0_f32), Just(1.0), Just(30.0), Just(3000.0)];
    (relief, prop_oneof![Just(0_u8), Just(5), Just(60), Just(180)], any::<u64>()).prop_map(
        move |(relief_m, gaps, seed)| {
            HeightGrid::from_fn(columns, rows, |c, r| {
                let noise = hash(seed ^ (c as u64) << 32 ^ r as u64);
                // Gaps come in blocks of various sizes, and singly.
                let block = hash(seed ^ (c as u64 / 3) << 40 ^ (r as u64 / 4) << 20);
                if (noise as u8) < gaps / 3 || (block as u8) < gaps {
                    return GAP;
                }
                let wave = (c as f32 * 0.4).sin() * (r as f32 * 0.3).cos();
                let cliff = if (c * 2 + r) % 23 < 11 { 0.2 } else { 0.0 };
                relief_m * (wave + cliff + (noise >> 40) as f32 / (1 << 26) as f32)
            })
        },
    )
}

/// Splitmix64's finisher: bits that look random.
fn hash(mut value: u64) -> u64 {
    value = (value ^ (value >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    value = (value ^ (value >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    value ^ (value >> 31)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// No node of the ground is farther from the TIN than the tolerance; the TIN covers the ground
    /// and nothing else; the same heights give the same TIN.
    #[test]
    fn every_tin_keeps_its_promises(heights in (4_usize..40, 4_usize..40).prop_flat_map(|(c, r)| terrain(c, r)), max_error_m in 0.1_f64..50.0) {
        let spec = TinSpec { max_error_m, quantum_m: height_quantum_m(max_error_m) };
        prop_assert_eq!(check(&heights, spec), triangulate(&heights, spec).unwrap());
    }

    /// Two tiles cut from one raster share their border bit for bit, each of them computed
    /// separately, wherever both have ground: next to each other and one above the other.
    #[test]
    fn neighbours_share_their_border(raster in terrain(35, 35), max_error_m in 0.1_f64..50.0) {
        let spec = TinSpec { max_error_m, quantum_m: height_quantum_m(max_error_m) };
        let tile = |c: usize, r: usize| triangulate(&raster.window(16 * c, 16 * r, 19, 19), spec).unwrap();
        let ground = |c: usize, r: usize| raster.cell_has_ground(c, r);
        // Border edges along column `c` (or row `c` if `turned`), as pairs of (position, height).
        let edges = |tin: &Tin, at: u16, turned: bool| {
            let mut found = BTreeSet::new();
            for triangle in tin.triangles() {
                for k in 0..3 {
                    let ends = [triangle[k], triangle[(k + 1) % 3]].map(|v| tin.vertices()[v as usize]);
                    let places = ends.map(|v| if turned { (v.row, v.column) } else { (v.column, v.row) });
                    if places.iter().all(|&(across, _)| across == at) {
                        let mut pair = [(places[0].1, ends[0].height_q), (places[1].1, ends[1].height_q)];
                        pair.sort_unstable();
                        found.insert(pair);
                    }
                }
            }
            found
        };
        for turned in [false, true] {
            let (first, second) = (tile(0, 0), if turned { tile(0, 1) } else { tile(1, 0) });
            // The shared line is raster column (or row) 17; segment s is between nodes s + 1 and s
            // + 2.
            let both = |s: u16| {
                let s = usize::from(s) + 1;
                if turned { ground(s, 16) && ground(s, 17) } else { ground(16, s) && ground(17, s) }
            };
            let shared = |edges: BTreeSet<[(u16, i32); 2]>| -> Vec<_> {
                edges.into_iter().filter(|pair| (pair[0].0..pair[1].0).all(both)).collect()
            };
            let (here, there) = (shared(edges(&first, 16, turned)), shared(edges(&second, 0, turned)));
            let covered: u16 = here.iter().map(|pair| pair[1].0 - pair[0].0).sum();
            prop_assert_eq!(usize::from(covered), (0..16).filter(|&s| both(s)).count());
            prop_assert_eq!(here, there);
        }
    }
}
