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
    columns_per_row: f64,
}

impl Edge {
    #[inline]
    fn new(from: [i64; 2], to: [i64; 2]) -> Self {
        let (columns, rows) = (to[0] - from[0], to[1] - from[1]);
        Self { from, columns, rows, columns_per_row: columns as f64 / rows as f64 }
    }

    /// The last column at or west of the edge.
    #[inline]
    fn floor(&self, row: i64) -> i64 {
        let down = row - self.from[1];
        let exact = down * self.columns;
        // The estimate is off by one at most; integers decide.
        let mut column = (down as f64 * self.columns_per_row) as i64;
        while column * self.rows > exact {
            column -= 1;
        }
        while (column + 1) * self.rows <= exact {
            column += 1;
        }
        self.from[0] + column
    }

    /// The first column at or east of the edge.
    #[inline]
    fn ceil(&self, row: i64) -> i64 {
        let down = row - self.from[1];
        let exact = down * self.columns;
        let mut column = (down as f64 * self.columns_per_row) as i64;
        while column * self.rows < exact {
            column += 1;
        }
        while (column - 1) * self.rows >= exact {
            column -= 1;
        }
        self.from[0] + column
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
        fn holds_the_nodes_inside(a in corner(), b in corner(), c in corner(), low in -25_i64..25, high in -25_i64..25) {
            let turn = |p: [i64; 2], q: [i64; 2], r: [i64; 2]| {
                (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
            };
            prop_assume!(turn(a, b, c) != 0);
            let mut found = Vec::new();
            for_each_row([a, b, c], low..=high, |row, first, last| {
                for column in first..=last {
                    found.push([column, row]);
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
    }
}
