//! The scan of a face finds its farthest node.

use corniche_geom::HeightGrid;
use proptest::prelude::*;

use super::*;

const SIDE: usize = 40;

/// A scan of heights of a tile of `SIDE` × `SIDE` nodes, with a tolerance of 1 m and steps of 1/32
/// m.
fn scan(height_m: impl Fn(usize, usize) -> f32) -> FaceScan {
    let heights = HeightGrid::from_fn(SIDE + 2, SIDE + 2, |c, r| {
        height_m(c.wrapping_sub(1), r.wrapping_sub(1))
    });
    FaceScan::new(&TileRaster::new(&heights, 1.0 / 32.0), 1.0, 1.0 / 32.0)
}

fn node([column, row]: [i64; 2], height_q: i32) -> TinVertex {
    TinVertex { column: column as u16, row: row as u16, height_q }
}

fn turn(p: [i64; 2], q: [i64; 2], r: [i64; 2]) -> i64 {
    (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
}

/// The rise of the plane through three nodes per row and per column, in metres, with heights in
/// steps of 1/32 m and without sign. The weight of a corner at a position changes by the opposite
/// side, turned by a right angle, divided by twice the area.
fn slopes_m(at: [[i64; 2]; 3], heights_q: [i32; 3]) -> [f64; 2] {
    let double_area = turn(at[0], at[1], at[2]) as f64;
    [0, 1].map(|axis| {
        let rise =
            |k: usize| (at[(k + 2) % 3][axis] - at[(k + 1) % 3][axis]) * i64::from(heights_q[k]);
        (0..3).map(rise).sum::<i64>() as f64 / 32.0 / double_area
    })
}

fn corner() -> impl Strategy<Value = [i64; 2]> {
    // Faces below and above the limit of small faces, and level edges, must all be common.
    (0_i64..40, 0_i64..40, prop_oneof![Just(4_i64), Just(12), Just(40)])
        .prop_map(|(column, row, most)| [column % most, row % most])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// A node is reported exactly if a node exceeds the tolerance in integer arithmetic, edges
    /// included; and then it is one of the farthest, except for rounding.
    #[test]
    fn finds_the_farthest(at in [corner(), corner(), corner()], heights_q in [-500..500, -500..500, -500..500], base_m in prop_oneof![Just(0_i32), Just(-300), Just(8000)], seed in any::<u32>()) {
        let at = if turn(at[0], at[1], at[2]) < 0 { [at[0], at[2], at[1]] } else { at };
        let area = turn(at[0], at[1], at[2]);
        prop_assume!(area > 0);
        let heights_q = heights_q.map(|height_q| height_q + 32 * base_m);
        // Heights are in steps of 1/128 m. Few different heights make equal distances, and
        // distances exactly at the tolerance, common.
        let height = |c: usize, r: usize| match at.iter().position(|&corner| corner == [c as i64, r as i64]) {
            Some(k) => 4 * i64::from(heights_q[k]),
            None => i64::from((seed ^ c.wrapping_mul(1000).wrapping_add(r) as u32).wrapping_mul(0x9e37_79b9) >> 28) * 256 + 128 * i64::from(base_m),
        };
        let far_of = |n: [i64; 2]| {
            let weights = [turn(at[1], at[2], n), turn(at[2], at[0], n), turn(at[0], at[1], n)];
            let plane: i64 = (0..3).map(|k| weights[k] * 4 * i64::from(heights_q[k])).sum();
            let is_inside = weights.iter().all(|&weight| weight >= 0);
            is_inside.then(|| (height(n[0] as usize, n[1] as usize) * area - plane).abs())
        };
        let inner = (1..SIDE as i64 - 1).flat_map(|r| (1..SIDE as i64 - 1).map(move |c| [c, r]));
        let farthest = inner.filter_map(far_of).max().unwrap_or(0);
        let scan = scan(|c, r| height(c, r) as f32 / 128.0);
        let found = scan.farthest_node([0, 1, 2].map(|k| node(at[k], heights_q[k])));
        prop_assert_eq!(found.far_m >= scan.beyond_m(), farthest > 128 * area);
        if farthest > 128 * area {
            let far = far_of([i64::from(found.node) % SIDE as i64, i64::from(found.node) / SIDE as i64]);
            let far_m = far.map(|far| far as f64 / 128.0 / area as f64).unwrap();
            let farthest_m = farthest as f64 / 128.0 / area as f64;
            // Slopes of slivers are steep, and then floats are less accurate. The rise of the plane
            // over the tile's columns and rows limits every intermediate number.
            let reach_m = (SIDE + 2) as f64 * slopes_m(at, heights_q).into_iter().map(f64::abs).sum::<f64>() + farthest_m;
            prop_assert!(far.unwrap() > 128 * area, "{} m is not too far", far_m);
            prop_assert!(farthest_m - far_m <= 2.0 * reach_m * DOUBT, "{} m instead of {} m", far_m, farthest_m);
            prop_assert!((f64::from(found.far_m) - far_m).abs() <= reach_m * DOUBT);
        }
    }

    /// Nodes of equal heights on a gentle plane: the node found is the farthest to within a
    /// thousandth.
    #[test]
    fn finds_the_farthest_on_gentle_ground(columns in 2_i64..39, rows in 2_i64..39, seed in any::<u32>()) {
        let height = |c: usize, r: usize| (seed ^ c.wrapping_mul(1000).wrapping_add(r) as u32).wrapping_mul(0x9e37_79b9) >> 20;
        let scan = scan(|c, r| height(c, r) as f32);
        let found = scan.farthest_node([node([0, 0], 0), node([columns, 0], 0), node([0, rows], 0)]);
        let inside = (1..rows).flat_map(|r| (1..columns).map(move |c| [c, r])).filter(|[c, r]| c * rows + r * columns <= columns * rows);
        let farthest = inside.map(|[c, r]| height(c as usize, r as usize)).max().unwrap_or(0);
        if farthest > 1 {
            let far = height(found.node as usize % SIDE, found.node as usize / SIDE);
            prop_assert!(f64::from(far) >= 0.999 * f64::from(farthest), "{} m instead of {} m", far, farthest);
        }
    }

    /// All faces around a node in a rectangle that contain a spike find it, even on their edges.
    #[test]
    fn a_spike_is_found_from_all_sides(west in 0_i64..4, north in 0_i64..4, columns in 2_i64..36, rows in 2_i64..36, places in [0.0_f64..1.0, 0.0..1.0, 0.0..1.0, 0.0..1.0]) {
        let inner = |k: usize| [
            west + 1 + (places[k] * (columns - 1) as f64) as i64,
            north + 1 + (places[k + 1] * (rows - 1) as f64) as i64,
        ];
        let (hub, spike) = (inner(0), inner(2));
        prop_assume!(hub != spike);
        let scan = scan(|c, r| if [c as i64, r as i64] == spike { 9.0 } else { 0.0 });
        let rim = [[west, north], [west + columns, north], [west + columns, north + rows], [west, north + rows]];
        let index = (spike[1] * SIDE as i64 + spike[0]) as u32;
        for k in 0..4 {
            let at = [hub, rim[k], rim[(k + 1) % 4]];
            let holds = (0..3).all(|k| turn(at[k], at[(k + 1) % 3], spike) >= 0);
            let found = scan.farthest_node(at.map(|at| node(at, 0)));
            prop_assert_eq!(found.far_m >= scan.beyond_m(), holds);
            prop_assert!(!holds || found.node == index && (found.far_m - 9.0).abs() < 0.001);
        }
    }
}

/// The rows use all 16 bits.
#[test]
fn finds_a_spike_in_far_rows() {
    for row in [10_usize, 32_766, 32_767, 32_768, 40_000, 65_500] {
        let heights =
            HeightGrid::from_fn(7, 65_537, |c, r| if (c, r) == (3, row + 1) { 9.0 } else { 0.0 });
        let scan = FaceScan::new(&TileRaster::new(&heights, 1.0 / 32.0), 1.0, 1.0 / 32.0);
        let north = row as i64 - 3;
        let corners = [[0, north], [4, north], [2, north + 8]].map(|at| node(at, 0));
        let found = scan.farthest_node(corners);
        assert_eq!(found.node, (5 * row + 2) as u32);
        assert!((found.far_m - 9.0).abs() < 0.001);
    }
}

/// A node exactly at the tolerance is accepted, one slightly above is not: for small faces and
/// large ones.
#[test]
fn the_tolerance_itself_is_allowed() {
    for size in [6, 30] {
        let corners = [[0, 0], [size, 0], [0, size]].map(|at| node(at, 32 * 8000));
        for (far_m, is_beyond) in
            [(1.0, false), (1.0 + 1.0 / 1024.0, true), (1.0 - 1.0 / 1024.0, false)]
        {
            let scan = scan(|c, r| if (c, r) == (2, 1) { 8000.0 + far_m } else { 8000.0 });
            let found = scan.farthest_node(corners);
            assert_eq!(found.far_m >= scan.beyond_m(), is_beyond, "{size} nodes, {far_m} m");
        }
    }
}
