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

    /// The node found lies in the face and is as far as said; no node inside the face is farther.
    #[test]
    fn finds_the_farthest(at in [corner(), corner(), corner()], heights_q in [-500..500, -500..500, -500..500], seed in any::<u32>()) {
        let at = if turn(at[0], at[1], at[2]) < 0 { [at[0], at[2], at[1]] } else { at };
        prop_assume!(turn(at[0], at[1], at[2]) > 0);
        let noise = |c: usize, r: usize| (seed ^ c.wrapping_mul(1000).wrapping_add(r) as u32).wrapping_mul(0x9e37_79b9) >> 20;
        let height_m = |c: usize, r: usize| noise(c, r) as f32 / 128.0;
        let corners = [0, 1, 2].map(|k| node(at[k], heights_q[k]));
        let found = scan(height_m).worst_node(corners);
        let distance_m = |n: [i64; 2]| {
            let weights = [turn(at[1], at[2], n), turn(at[2], at[0], n), turn(at[0], at[1], n)];
            let plane_m: f64 = (0..3).map(|k| weights[k] as f64 * f64::from(heights_q[k]) / 32.0).sum::<f64>()
                / turn(at[0], at[1], at[2]) as f64;
            (weights, (f64::from(height_m(n[0] as usize, n[1] as usize)) - plane_m).abs())
        };
        let mut inside_m = 0.0_f64;
        for n in (1..SIDE as i64 - 1).flat_map(|r| (1..SIDE as i64 - 1).map(move |c| [c, r])) {
            let (weights, far_m) = distance_m(n);
            if weights.iter().all(|&weight| weight > 0) {
                inside_m = inside_m.max(far_m);
            }
        }
        if let Some((error_m, index)) = found {
            let (weights, far_m) = distance_m([i64::from(index) % SIDE as i64, i64::from(index) / SIDE as i64]);
            prop_assert!(weights.iter().all(|&weight| weight >= 0), "{weights:?}");
            prop_assert!((far_m - error_m).abs() < 1e-9, "{far_m} {error_m}");
            prop_assert!(error_m > 1.0 && error_m > inside_m - 1e-9, "{error_m} {inside_m}");
        } else {
            prop_assert!(inside_m <= 1.0 + 1e-9, "{inside_m}");
        }
    }

    /// Of the faces around a node in a rectangle, one finds a spike, wherever it stands: on edges too.
    #[test]
    fn a_spike_is_found_once(west in 0_i64..4, north in 0_i64..4, columns in 2_i64..36, rows in 2_i64..36, places in [0.0_f64..1.0, 0.0..1.0, 0.0..1.0, 0.0..1.0]) {
        let inner = |k: usize| [
            west + 1 + (places[k] * (columns - 1) as f64) as i64,
            north + 1 + (places[k + 1] * (rows - 1) as f64) as i64,
        ];
        let (hub, spike) = (inner(0), inner(2));
        prop_assume!(hub != spike);
        let scan = scan(|c, r| if [c as i64, r as i64] == spike { 9.0 } else { 0.0 });
        let rim = [[west, north], [west + columns, north], [west + columns, north + rows], [west, north + rows]];
        let found: Vec<_> = (0..4)
            .filter_map(|k| scan.worst_node([hub, rim[k], rim[(k + 1) % 4]].map(|at| node(at, 0))))
            .collect();
        // Faces that are not small both look at the nodes of the edge between them.
        let once = columns.max(rows) < SMALL as i64;
        prop_assert!(found.len() == 1 || (!once && found.len() == 2), "{found:?}");
        let index = (spike[1] * SIDE as i64 + spike[0]) as u32;
        prop_assert!(found.iter().all(|&found| found == (9.0, index)), "{found:?}");
    }
}
