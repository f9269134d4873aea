//! The rows of a triangle contain exactly its nodes.

use super::*;
use proptest::prelude::*;

fn corner() -> impl Strategy<Value = [i64; 2]> {
    (-20_i64..20, -20_i64..20).prop_map(|(column, row)| [column, row])
}

proptest! {
    /// The rows contain exactly the nodes whose three edge functions do not differ in sign.
    #[test]
    fn holds_the_nodes_inside(
        shift in prop_oneof![Just(0_i64), Just(25), Just(60_000), Just(-60_000), Just(1 << 24), Just(1 << 29), Just(-(1 << 29))],
        a in corner(), b in corner(), c in corner(), low in -25_i64..25, high in -25_i64..25) {
        let turn = |p: [i64; 2], q: [i64; 2], r: [i64; 2]| {
            (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
        };
        prop_assume!(turn(a, b, c) != 0);
        let mut found = Vec::new();
        let shifted = [a, b, c].map(|corner| corner.map(|value| value + shift));
        for_each_row(shifted, low + shift..=high + shift, |row, first, last| {
            for column in first..=last {
                found.push([column - shift, row - shift]);
            }
        });
        let mut wanted = Vec::new();
        for row in low..=high {
            for column in -25..25 {
                let n = [column, row];
                let sides = [turn(a, b, n), turn(b, c, n), turn(c, a, n)];
                if sides.iter().all(|&s| s >= 0) || sides.iter().all(|&s| s <= 0) {
                    wanted.push(n);
                }
            }
        }
        prop_assert_eq!(found, wanted);
    }

    /// Fixed-point arithmetic and division find the same columns, even for the longest edges in
    /// fixed point.
    #[test]
    fn fixed_point_is_exact(
        from in (-(1_i64 << 29)..1 << 29, -(1_i64 << 29)..1 << 29),
        columns in prop_oneof![1 - SHORT_COLUMNS..SHORT_COLUMNS, -40_i64..40],
        rows in prop_oneof![1..SHORT_ROWS, SHORT_ROWS - 40..SHORT_ROWS, 1_i64..40],
        at in 0.0_f64..=1.0,
    ) {
        let (from, to) = ([from.0, from.1], [from.0 + columns, from.1 + rows]);
        let edge = Edge::new(from, to);
        let divided = Edge { is_short: false, ..Edge::new(from, to) };
        prop_assert!(edge.is_short);
        for row in [from[1] + (rows as f64 * at) as i64, to[1], to[1] - 1] {
            prop_assert_eq!([edge.floor(row), edge.ceil(row)], [divided.floor(row), divided.ceil(row)]);
        }
    }
}
