//! The rows of a triangle hold exactly the nodes in it.

use super::*;
use proptest::prelude::*;

fn corner() -> impl Strategy<Value = [i64; 2]> {
    (-20_i64..20, -20_i64..20).prop_map(|(column, row)| [column, row])
}

proptest! {
    /// The rows hold exactly the nodes whose three edge functions do not differ in sign.
    #[test]
    fn holds_the_nodes_inside(
        shift in prop_oneof![Just(0_i64), Just(25), Just(60_000), Just(FLOATS_REACH - 26), Just(FLOATS_REACH), Just(1 << 29)],
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

    /// Floats and integers find the same columns, also of edges as long as floats may take.
    #[test]
    fn floats_are_exact(
        from in (0..FLOATS_REACH, 0..FLOATS_REACH), to in (0..FLOATS_REACH, 0..FLOATS_REACH), at in 0.0_f64..=1.0,
    ) {
        prop_assume!(from.1 < to.1);
        let edge = Edge::new([from.0, from.1], [to.0, to.1]);
        let row = from.1 + ((to.1 - from.1) as f64 * at) as i64;
        let exact = Edge { in_floats: false, ..Edge::new([from.0, from.1], [to.0, to.1]) };
        prop_assert!(edge.in_floats);
        prop_assert_eq!([edge.floor(row), edge.ceil(row)], [exact.floor(row), exact.ceil(row)]);
    }
}
