/// Calls `each(row, first_column, last_column)` for every row of nodes that the triangle `corners`
/// (`[column, row]`) holds, edges included, within `rows` and from north to south.
///
/// Columns are exact: a node on an edge belongs to both triangles beside it. Corners must lie within ±2^30.
#[inline]
pub(crate) fn for_each_row(
    corners: [[i64; 2]; 3],
    rows: std::ops::RangeInclusive<i64>,
    mut each: impl FnMut(i64, i64, i64),
) {
    // Corners from north to south; the long edge runs from the first to the last.
    //
    //        a            The triangle lies between the long edge a–c and the two short ones.
    //        │ ╲
    //        │   b
    //        │ ╱
    //        c
    let [mut a, mut b, mut c] = corners;
    if b[1] < a[1] {
        std::mem::swap(&mut a, &mut b);
    }
    if c[1] < b[1] {
        std::mem::swap(&mut b, &mut c);
        if b[1] < a[1] {
            std::mem::swap(&mut a, &mut b);
        }
    }
    let (first, last) = (a[1].max(*rows.start()), c[1].min(*rows.end()));
    if a[1] == c[1] {
        return; // No area.
    }
    let b_is_east = (b[0] - a[0]) * (c[1] - a[1]) > (c[0] - a[0]) * (b[1] - a[1]);
    let long = Edge::new(a, c);
    let upper = Edge::new(a, b);
    let lower = Edge::new(b, c);
    for row in first..=last {
        // At the row of `b` either short edge will do, unless it is level and does not end there alone.
        let short = if row < b[1] || (row == b[1] && c[1] == b[1]) { &upper } else { &lower };
        let (west, east) = if b_is_east { (&long, short) } else { (short, &long) };
        each(row, west.ceil(row), east.floor(row));
    }
}

/// An edge that is not level, as columns over rows.
struct Edge {
    from: [i64; 2],
    columns: i64,
    rows: i64,
    rows_inverse: f64,
    in_floats: bool,
}

/// Below this, floats find columns exactly: see [`Edge::floor`].
const FLOATS_REACH: i64 = 1 << 24;

impl Edge {
    #[inline]
    fn new(from: [i64; 2], to: [i64; 2]) -> Self {
        let (columns, rows) = (to[0] - from[0], to[1] - from[1]);
        // Of coordinates from 0 up, none has a bit that the reach has not.
        let in_floats =
            (from[0] | to[0] | from[1] | to[1]) as u64 >> FLOATS_REACH.trailing_zeros() == 0;
        Self { from, columns, rows, rows_inverse: 1.0 / rows as f64, in_floats }
    }

    /// The last column at or west of the edge.
    #[inline]
    fn floor(&self, row: i64) -> i64 {
        self.column((row - self.from[1]) * self.columns)
    }

    /// The first column at or east of the edge.
    #[inline]
    fn ceil(&self, row: i64) -> i64 {
        self.column((row - self.from[1]) * self.columns + self.rows - 1)
    }

    /// The first corner's column + `across` / rows, rounded down.
    ///
    /// In floats without a branch: half a step more keeps the fraction 0.5 / rows or more away from whole
    /// numbers, 2^-25 at least, while below 2^24 all rounding together stays under 2^-27; and no column is
    /// negative, so cutting off the fraction rounds down.
    #[inline]
    fn column(&self, across: i64) -> i64 {
        if self.in_floats {
            (self.from[0] as f64 + (across as f64 + 0.5) * self.rows_inverse) as i64
        } else {
            self.from[0] + across.div_euclid(self.rows)
        }
    }
}

#[cfg(test)]
mod tests {
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
}
