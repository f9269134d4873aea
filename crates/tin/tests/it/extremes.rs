//! Heights and shapes at the limits of a tile: the TIN fulfils its promises, or an error says which
//! one it cannot fulfil.

use corniche_geom::HeightGrid;
use corniche_testing::{check_covers_ground, check_tin};
use corniche_tin::{Tin, TinSpec, TriangulateError, height_quantum_m, triangulate};
use proptest::prelude::*;

const GAP: f32 = f32::NAN;

fn spec(max_error_m: f64) -> TinSpec {
    TinSpec { max_error_m, quantum_m: height_quantum_m(max_error_m) }
}

/// Triangulates, and checks every promise with simple methods.
fn check(heights: &HeightGrid, spec: TinSpec) -> Result<Tin, TriangulateError> {
    let tin = triangulate(heights, spec)?;
    check_tin(&tin);
    check_covers_ground(&tin, heights);
    check_area(&tin, heights);
    check_vertices(&tin, heights, spec.quantum_m);
    let worst = worst_error(&tin, heights, spec.quantum_m);
    assert!(worst <= exact(spec.max_error_m), "{} m off", worst.to_f64());
    Ok(tin)
}

/// Triangulates and checks like [`check`], and fails if there is no TIN.
fn sound(heights: &HeightGrid, max_error_m: f64) -> Tin {
    match check(heights, spec(max_error_m)) {
        Ok(tin) => tin,
        Err(error) => panic!("{error}"),
    }
}

/// The ground cells of the tile, without the halo.
fn ground_cells(heights: &HeightGrid) -> impl Iterator<Item = [usize; 2]> {
    (1..heights.rows() - 2)
        .flat_map(|row| (1..heights.columns() - 2).map(move |column| [column, row]))
        .filter(|&[column, row]| heights.cell_has_ground(column, row))
        .map(|[column, row]| [column - 1, row - 1])
}

/// The columns and rows of a triangle's corners.
fn corners(tin: &Tin, triangle: [u32; 3]) -> [[i64; 2]; 3] {
    triangle.map(|vertex| {
        let vertex = tin.vertices()[vertex as usize];
        [i64::from(vertex.column), i64::from(vertex.row)]
    })
}

/// Twice the signed area of a triangle in columns and rows.
fn turn(a: [i64; 2], b: [i64; 2], c: [i64; 2]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Seen from above the TIN is the ground: it has the same area, and covers the middle of every
/// ground cell. Exact integers.
fn check_area(tin: &Tin, heights: &HeightGrid) {
    let doubled: i64 = tin
        .triangles()
        .iter()
        .map(|&triangle| {
            let [a, b, c] = corners(tin, triangle);
            turn(a, b, c).abs()
        })
        .sum();
    assert_eq!(doubled, 2 * ground_cells(heights).count() as i64, "twice the area");
    for [column, row] in ground_cells(heights) {
        let middle = [2 * column as i64 + 1, 2 * row as i64 + 1];
        let covered = tin.triangles().iter().any(|&triangle| {
            let [a, b, c] = corners(tin, triangle).map(|corner| corner.map(|at| 2 * at));
            let sides = [turn(a, b, middle), turn(b, c, middle), turn(c, a, middle)];
            sides.iter().all(|&side| side <= 0)
        });
        assert!(covered, "the cell at column {column}, row {row} has ground and no triangle");
    }
}

/// A vertex is a node with a height, rounded to the nearest step.
fn check_vertices(tin: &Tin, heights: &HeightGrid, quantum_m: f64) {
    for vertex in tin.vertices() {
        let node = heights.height(usize::from(vertex.column) + 1, usize::from(vertex.row) + 1);
        let height_m = f64::from(node.expect("a vertex has a height"));
        let off_m = (f64::from(vertex.height_q) * quantum_m - height_m).abs();
        assert!(off_m <= quantum_m / 2.0, "{vertex:?} is {off_m} m off its node");
    }
}

/// A non-negative fraction of integers, for exact comparison.
#[derive(Debug, Clone, Copy)]
struct Fraction {
    over: i128,
    under: i128,
}

impl Fraction {
    fn to_f64(self) -> f64 {
        self.over as f64 / self.under as f64 * FINEST_M
    }
}

impl PartialEq for Fraction {
    fn eq(&self, other: &Self) -> bool {
        self.over * other.under == other.over * self.under
    }
}

impl PartialOrd for Fraction {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        (self.over * other.under).partial_cmp(&(other.over * self.under))
    }
}

/// The unit of exact heights: 2^-30 m. Heights in these tests are multiples of it.
const FINEST_M: f64 = 1.0 / (1_u64 << 30) as f64;

/// Converts a height to whole units.
fn units(metres: f64) -> i128 {
    let scaled = metres / FINEST_M;
    assert!(scaled.fract() == 0.0 && scaled.abs() < 2e37, "{metres} m is no whole number of units");
    scaled as i128
}

fn exact(metres: f64) -> Fraction {
    // The result is rounded up: a tolerance need not be a multiple of the unit.
    let scaled = (metres / FINEST_M).ceil();
    Fraction { over: if scaled < 1e37 { scaled as i128 } else { 10_i128.pow(37) }, under: 1 }
}

/// The largest error at any node that the TIN covers: every node against every triangle, in
/// integers.
fn worst_error(tin: &Tin, heights: &HeightGrid, quantum_m: f64) -> Fraction {
    let mut worst = Fraction { over: 0, under: 1 };
    for &triangle in tin.triangles() {
        let [a, b, c] = corners(tin, triangle);
        let stored = triangle
            .map(|vertex| i128::from(tin.vertices()[vertex as usize].height_q) * units(quantum_m));
        let total = i128::from(turn(a, b, c));
        for row in 0..heights.rows() - 2 {
            for column in 0..heights.columns() - 2 {
                let node = [column as i64, row as i64];
                let weights = [turn(b, c, node), turn(c, a, node), turn(a, b, node)];
                // Rows count to the south, so triangles that are counter-clockwise seen from above
                // are clockwise here.
                if weights.iter().any(|&weight| weight > 0) {
                    continue;
                }
                let height_m = heights.height(column + 1, row + 1).expect("a node on the ground");
                let on_plane: i128 = weights
                    .iter()
                    .zip(stored)
                    .map(|(&weight, height)| i128::from(weight) * height)
                    .sum();
                let over = (units(f64::from(height_m)) * total - on_plane).abs();
                let error = Fraction { over, under: total.abs() };
                if error > worst {
                    worst = error;
                }
            }
        }
    }
    worst
}

/// A tile with a halo of its own heights, which are computed from column and row.
fn tile(side: usize, height_m: impl Fn(usize, usize) -> f32) -> HeightGrid {
    HeightGrid::from_fn(side + 2, side + 2, height_m)
}

#[test]
fn heights_fill_the_whole_range_of_steps_and_not_one_more() {
    // Steps of 1 m: ±(2^31 − 2) are the last accepted heights; f32 has no number between 2^31 − 128
    // and 2^31.
    let spec = TinSpec { max_error_m: 32.0, quantum_m: 1.0 };
    let last = 2_147_483_520.0_f32;
    let heights = tile(9, |c, r| if (c + r) % 3 == 0 { last } else { -last });
    let tin = check(&heights, spec).unwrap();
    let steps: Vec<i32> = tin.vertices().iter().map(|vertex| vertex.height_q).collect();
    assert_eq!(
        (steps.iter().min(), steps.iter().max()),
        (Some(&-2_147_483_520), Some(&2_147_483_520))
    );
    for beyond in [2_147_483_648.0_f32, -2_147_483_648.0, 1e30, -1e30, f32::MAX, f32::MIN] {
        let heights = tile(9, |c, r| if (c, r) == (4, 4) { beyond } else { 0.0 });
        let refused = check(&heights, spec);
        assert_eq!(refused, Err(TriangulateError::Height { height_m: beyond, quantum_m: 1.0 }));
    }
    // An invalid height only in the halo does no harm to the tile, but the neighbour that contains
    // it would reject it: so this tile rejects it, too.
    let halo = tile(9, |c, _| if c == 0 { 1e30 } else { 0.0 });
    assert!(matches!(check(&halo, spec), Err(TriangulateError::Height { .. })));
}

#[test]
fn steps_of_1e30_metres_are_steps() {
    // With this quantum 1e30 m fits. The order of equally distant nodes depends on the unit: small
    // numbers are compared in 32-bit floats, large ones exactly.
    // 32-bit floats, large ones exactly.
    let low = tile(17, |c, r| if (c / 4 + r / 4) % 2 == 0 { 0.0 } else { 1024.0 });
    let high = tile(17, |c, r| if (c / 4 + r / 4) % 2 == 0 { 0.0 } else { 2.0_f32.powi(100) });
    let scale = 2.0_f64.powi(90);
    let spec = spec(64.0);
    let expected = check(&low, spec).unwrap();
    let scaled =
        TinSpec { max_error_m: spec.max_error_m * scale, quantum_m: spec.quantum_m * scale };
    let tin = triangulate(&high, scaled).unwrap();
    check_tin(&tin);
    check_covers_ground(&tin, &high);
    // In steps, both are TINs of the same heights.
    check_vertices(&tin, &low, spec.quantum_m);
    assert!(worst_error(&tin, &low, spec.quantum_m) <= exact(spec.max_error_m));
    let [vertices, others] = [&tin, &expected].map(|tin| tin.vertices().len());
    assert!(vertices > 100 && vertices.abs_diff(others) * 10 < others, "{vertices}, {others}");
}

#[test]
fn a_tolerance_of_almost_nothing_makes_every_uneven_node_a_vertex() {
    let noise = tile(17, |c, r| ((c * c * 7919 + r * r * 10_473 + c * r * 31) % 1009) as f32);
    assert_eq!(sound(&noise, 1.0 / 1024.0).vertices().len(), 17 * 17);
    // Level ground needs only four vertices, however small the tolerance is.
    assert_eq!(sound(&tile(17, |_, _| 1009.0), 1.0 / 1024.0).vertices().len(), 4);
    // A tolerance below the resolution of 32-bit steps at this height is rejected.
    let fine = TinSpec { max_error_m: 1e-9, quantum_m: height_quantum_m(1e-9) };
    assert!(matches!(check(&noise, fine), Err(TriangulateError::Height { .. })));
    let none =
        TinSpec { max_error_m: f64::MIN_POSITIVE, quantum_m: height_quantum_m(f64::MIN_POSITIVE) };
    assert!(matches!(check(&noise, none), Err(TriangulateError::Spec { .. })));
}

#[test]
fn a_huge_tolerance_leaves_the_boundary_alone() {
    let noise = tile(17, |c, r| ((c * c * 7919 + r * r * 10_473 + c * r * 31) % 1009) as f32);
    for max_error_m in [2048.0, 1e9, 1e30, f64::MAX] {
        let tin = triangulate(&noise, spec(max_error_m)).unwrap();
        check_tin(&tin);
        check_covers_ground(&tin, &noise);
        assert_eq!((tin.vertices().len(), tin.triangles().len()), (4, 2), "{max_error_m}");
    }
    // With a void inside, its corners are vertices, too.
    let holed =
        tile(17, |c, r| if (7..10).contains(&c) && (7..10).contains(&r) { GAP } else { 5.0 });
    assert_eq!(sound(&holed, 1e9).vertices().len(), 4 + 4);
}

/// With a quantum as large as the tolerance, rounding alone uses half of the tolerance.
#[test]
fn the_highest_quantum_still_keeps_the_tolerance() {
    let noise =
        tile(17, |c, r| ((c * c * 7919 + r * r * 10_473 + c * r * 31) % 1009) as f32 / 16.0);
    let tin = check(&noise, TinSpec { max_error_m: 1.0, quantum_m: 1.0 }).unwrap();
    assert!(tin.vertices().len() > 100);
    let too_high = TinSpec { max_error_m: 1.0, quantum_m: 1.0 + f64::EPSILON };
    assert!(matches!(check(&noise, too_high), Err(TriangulateError::Spec { .. })));
}

/// Values that occur next to nodata in real files: denormals, and both zeros.
#[test]
fn tiny_heights_are_zero() {
    let tiny = [4e-27_f32, -4e-27, f32::MIN_POSITIVE, 1e-45, 0.0, -0.0];
    let heights = tile(9, |c, r| tiny[(c * 3 + r) % tiny.len()]);
    let tin = triangulate(&heights, spec(2.0)).unwrap();
    check_tin(&tin);
    assert_eq!((tin.vertices().len(), tin.triangles().len()), (4, 2));
    assert!(tin.vertices().iter().all(|vertex| vertex.height_q == 0));
}

#[test]
fn the_smallest_and_thinnest_tiles_are_whole() {
    for (columns, rows) in [(4, 4), (4, 40), (40, 4), (5, 5), (4, 300)] {
        for relief_m in [0.0_f32, 500.0] {
            let heights =
                HeightGrid::from_fn(columns, rows, |c, r| relief_m * ((c * 5 + r * 3) % 7) as f32);
            let tin = sound(&heights, 1.0);
            assert!(tin.triangles().len() >= 2, "{columns} × {rows}");
        }
    }
}

/// A window drawn in characters, halo included: `#` is a height, any other character is a gap.
fn drawn(rows: &[&str]) -> HeightGrid {
    HeightGrid::from_fn(rows[0].len(), rows.len(), |c, r| {
        let relief = (c * c * 3 + r * 5) % 11;
        if rows[r].as_bytes()[c] == b'#' { 10.0 * relief as f32 } else { GAP }
    })
}

#[test]
fn a_halo_of_gaps_or_of_ground_alone_changes_nothing_inside() {
    let bare = drawn(&["......", ".####.", ".####.", ".####.", ".####.", "......"]);
    let whole = drawn(&["######", "######", "######", "######", "######", "######"]);
    let (alone, among) = (sound(&bare, 1e6), sound(&whole, 1e6));
    assert_eq!(alone, among);
    let lonely = drawn(&["######", "#....#", "#....#", "#....#", "#....#", "######"]);
    assert_eq!(sound(&lonely, 1.0), Tin::default());
    let corner = drawn(&["##....", "##....", "......", "......", "......", "......"]);
    assert_eq!(sound(&corner, 1.0), Tin::default(), "a halo cell is not the tile's");
}

#[test]
fn cells_that_touch_in_a_point_share_a_vertex_and_no_edge() {
    // One cell, two cells corner to corner, and a whole chain of them, inside and on the tile's
    // corner.
    let cases: [(&[&str], usize, usize); 5] = [
        (&["......", ".##...", ".##...", "......", "......", "......"], 4, 2),
        (&["......", ".##...", ".###..", "..##..", "......", "......"], 7, 4),
        (&["......", "..##..", ".###..", ".##...", "......", "......"], 7, 4),
        (&[".......", ".##....", ".###...", "..###..", "...##..", "......."], 10, 6),
        // Four cells around a void cell, each touching two others in a point.
        (&[".......", "..##...", ".####..", ".##.##.", "..####.", "...##..", "......."], 16, 11),
    ];
    for (rows, vertices, triangles) in &cases[..4] {
        let tin = sound(&drawn(rows), 1e6);
        assert_eq!(
            (tin.vertices().len(), tin.triangles().len()),
            (*vertices, *triangles),
            "{rows:#?}"
        );
    }
    let ring = sound(&drawn(cases[4].0), 1.0);
    assert!(!ring.is_empty());
}

#[test]
fn checkerboards_of_voids_have_exactly_the_ground_between() {
    for (period, cells) in [(2, 0), (3, 0), (4, 1), (6, 1), (8, 1)] {
        // Squares of half a period, alternating between ground and void.
        let half = period / 2;
        let board = tile(33, |c, r| {
            if (c / half.max(1) + r / half.max(1)) % 2 == 0 { (c + r) as f32 } else { GAP }
        });
        let tin = sound(&board, 0.5);
        assert_eq!(!tin.is_empty(), cells > 0, "period {period}");
    }
    // Single void nodes in a regular pattern: every cell that touches one is lost.
    let holes = tile(33, |c, r| if c % 5 == 2 && r % 5 == 2 { GAP } else { (c * r) as f32 });
    assert!(!sound(&holes, 0.5).is_empty());
    // Columns of ground one cell wide between columns of void, and columns of nodes without any
    // cell.
    let stripes = tile(33, |c, r| if c % 3 == 0 { GAP } else { (c * 7 + r) as f32 });
    assert_eq!(ground_cells(&stripes).count(), 11 * 32);
    sound(&stripes, 0.5);
    let columns = tile(33, |c, r| if c % 2 == 0 { GAP } else { (c * 7 + r) as f32 });
    assert_eq!(sound(&columns, 0.5), Tin::default());
}

/// Small windows of any kind: flat, sloping, rough, with single gaps and runs of gaps, even in the
/// halo.
fn window() -> impl Strategy<Value = HeightGrid> {
    let height = prop_oneof![
        4 => (-8_i32..8).prop_map(|steps| steps as f32 / 4.0),
        2 => (-2000_i32..2000).prop_map(|metres| metres as f32),
        1 => prop_oneof![Just(8848.86_f32), Just(-10_935.0), Just(65_536.0), Just(0.062_5)],
        2 => Just(GAP),
    ];
    (4_usize..14, 4_usize..14, prop::sample::select(vec![0_u8, 1, 2])).prop_flat_map(
        move |(columns, rows, kind)| {
            prop::collection::vec(height.clone(), columns * rows).prop_map(move |heights_m| {
                HeightGrid::from_fn(columns, rows, |c, r| match kind {
                    // Random nodes; runs of two; or gaps at random nodes on a plane.
                    0 => heights_m[r * columns + c],
                    1 => heights_m[r / 2 * columns + c / 2],
                    _ if heights_m[r * columns + c].is_nan() => GAP,
                    _ => 3.0 * c as f32 - 0.5 * r as f32,
                })
            })
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    /// Whatever the heights: exact invariants, exact boundary, and no covered node farther than the
    /// tolerance, by integer arithmetic over every node and every triangle.
    #[test]
    fn any_small_window_is_kept(heights in window(), tolerance in 0_usize..6) {
        let max_error_m = [0.002, 0.125, 1.0, 7.0, 300.0, 1e6][tolerance];
        let tin = sound(&heights, max_error_m);
        prop_assert_eq!(tin.is_empty(), ground_cells(&heights).count() == 0);
    }
}
