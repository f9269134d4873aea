//! The nodes in a triangle, found row by row in whole numbers.

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
        // In the row of `b` both short edges give the same column, unless one of them is level.
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

/// Below this number, floating point finds columns exactly: see [`Edge::floor`].
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
#[path = "triangle_rows_tests.rs"]
mod tests;
