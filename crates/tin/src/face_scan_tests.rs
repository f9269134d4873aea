//! The scan of a face finds its farthest node.

use corniche_geom::HeightGrid;
use proptest::prelude::*;

use super::*;

const SIDE: usize = 40;

/// A scan over heights of a tile of `SIDE` × `SIDE` nodes, with a tolerance of 1 m and steps of 1/32 m.
fn scan(height_m: impl Fn(usize, usize) -> f32) -> FaceScan {
    let heights = HeightGrid::from_fn(SIDE + 2, SIDE + 2, |c, r| {
        height_m(c.wrapping_sub(1), r.wrapping_sub(1))
    });
    FaceScan::new(&TileRaster::new(&heights, 1.0 / 32.0), 1.0, 1.0 / 32.0)
}

fn node([column, row]: [i64; 2], height_q: i32) -> Node {
    Node { column: column as u16, row: row as u16, height_q }
}

fn turn(p: [i64; 2], q: [i64; 2], r: [i64; 2]) -> i64 {
    (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
}

fn corner() -> impl Strategy<Value = [i64; 2]> {
    // Faces below and above the limit of small ones, and level edges, must all be common.
    (0_i64..40, 0_i64..40, prop_oneof![Just(4_i64), Just(12), Just(40)])
        .prop_map(|(column, row, most)| [column % most, row % most])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// The node found is the farthest of all that the face holds, edges included, the first of equals, in whole numbers.
    #[test]
    fn finds_the_farthest(at in [corner(), corner(), corner()], heights_q in [-500..500, -500..500, -500..500], seed in any::<u32>()) {
        let at = if turn(at[0], at[1], at[2]) < 0 { [at[0], at[2], at[1]] } else { at };
        let area = turn(at[0], at[1], at[2]);
        prop_assume!(area > 0);
        // In steps of 1/128 m. Few different heights, so that equals are common.
        let height = |c: usize, r: usize| match at.iter().position(|&corner| corner == [c as i64, r as i64]) {
            Some(k) => 4 * i64::from(heights_q[k]),
            None => i64::from((seed ^ c.wrapping_mul(1000).wrapping_add(r) as u32).wrapping_mul(0x9e37_79b9) >> 28) * 256,
        };
        let mut farthest = (128 * area, None);
        for n in (1..SIDE as i64 - 1).flat_map(|r| (1..SIDE as i64 - 1).map(move |c| [c, r])) {
            let weights = [turn(at[1], at[2], n), turn(at[2], at[0], n), turn(at[0], at[1], n)];
            let plane: i64 = (0..3).map(|k| weights[k] * 4 * i64::from(heights_q[k])).sum();
            let far = (height(n[0] as usize, n[1] as usize) * area - plane).abs();
            if far > farthest.0 && weights.iter().all(|&weight| weight >= 0) {
                farthest = (far, Some((n[1] * SIDE as i64 + n[0]) as u32));
            }
        }
        let wanted = farthest.1.map(|index| (farthest.0 as f64 / 128.0 / area as f64, index));
        let corners = [0, 1, 2].map(|k| node(at[k], heights_q[k]));
        prop_assert_eq!(scan(|c, r| height(c, r) as f32 / 128.0).worst_node(corners), wanted);
    }

    /// Of the faces around a node in a rectangle, all that hold a spike find it, on their edges too.
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
            prop_assert_eq!(scan.worst_node(at.map(|at| node(at, 0))), holds.then_some((9.0, index)));
        }
    }
}

/// Rows fill all 16 bits.
#[test]
fn finds_a_spike_in_far_rows() {
    for row in [10_usize, 32_766, 32_767, 32_768, 40_000, 65_500] {
        let heights =
            HeightGrid::from_fn(7, 65_537, |c, r| if (c, r) == (3, row + 1) { 9.0 } else { 0.0 });
        let scan = FaceScan::new(&TileRaster::new(&heights, 1.0 / 32.0), 1.0, 1.0 / 32.0);
        let north = row as i64 - 3;
        let corners = [[0, north], [4, north], [2, north + 8]].map(|at| node(at, 0));
        assert_eq!(scan.worst_node(corners), Some((9.0, (5 * row + 2) as u32)));
    }
}
