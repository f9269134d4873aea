//! The nodes in a triangle, found row by row in integer arithmetic.

/// Calls `each(row, first_column, last_column)` for every row of nodes in the triangle `corners`
/// (`[column, row]`), edges included, within `rows` and from north to south.
///
/// Columns are exact: a node on an edge belongs to both adjacent triangles. Corners must be within
/// ±2^30.
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

/// An edge that is not level: columns as a function of rows.
struct Edge {
    from: [i64; 2],
    columns: i64,
    rows: i64,
    /// Whether the fields below are used for finding columns: see [`Edge::floor`].
    is_short: bool,
    /// In units of 2^-32: the column of the first corner, the columns per row, and half a step.
    start: i64,
    slope: i64,
    half_step: i64,
}

/// An edge over fewer rows than this, and fewer columns than `SHORT_COLUMNS`, is followed in
/// fixed-point arithmetic.
const SHORT_ROWS: i64 = 1 << 14;
const SHORT_COLUMNS: i64 = 1 << 20;

/// The number of fractional bits.
const FRACTION_BITS: u32 = 32;
const ONE: i64 = 1 << FRACTION_BITS;

impl Edge {
    #[inline]
    fn new(from: [i64; 2], to: [i64; 2]) -> Self {
        let (columns, rows) = (to[0] - from[0], to[1] - from[1]);
        // This avoids a division of integers, which is slow.
        let inverse = ONE as f64 / rows as f64;
        Self {
            from,
            columns,
            rows,
            is_short: rows < SHORT_ROWS && columns.abs() < SHORT_COLUMNS,
            start: from[0] << FRACTION_BITS,
            slope: (columns as f64 * inverse) as i64,
            half_step: (inverse / 2.0) as i64,
        }
    }

    /// The last column at or west of the edge.
    ///
    /// Columns of an edge are multiples of 1 / `rows`. Half a step more keeps a column away from
    /// whole numbers by this distance, which is at least 2^-15, because a short edge has fewer than
    /// 2^14 rows. Its slope is below 2^52 units, so two roundings of floats and the truncation
    /// cause an error of at most 2 units in the slope, and less than 2^15 units of 2^-32 in the
    /// column, plus those of half a step.
    #[inline]
    fn floor(&self, row: i64) -> i64 {
        let down = row - self.from[1];
        if self.is_short {
            (self.start + down * self.slope + self.half_step) >> FRACTION_BITS
        } else {
            self.from[0] + (down * self.columns).div_euclid(self.rows)
        }
    }

    /// The first column at or east of the edge: the last column at or west of a position that is a
    /// column minus a step farther east.
    #[inline]
    fn ceil(&self, row: i64) -> i64 {
        let down = row - self.from[1];
        if self.is_short {
            (self.start + down * self.slope + (ONE - self.half_step)) >> FRACTION_BITS
        } else {
            self.from[0] + (down * self.columns + self.rows - 1).div_euclid(self.rows)
        }
    }
}

#[cfg(test)]
#[path = "triangle_rows_tests.rs"]
mod tests;
