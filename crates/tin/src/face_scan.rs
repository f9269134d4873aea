//! The node of a face that lies farthest from it.

use crate::node::Node;
use crate::tile_raster::TileRaster;
use crate::triangle_rows::for_each_row;

/// Nodes looked at together. Rows of a face are short: most have no more.
const LANES: usize = 4;

/// Added to distances: nothing to those of a row, NaN to those of lanes after it. Starts as many lanes in as are not used.
const AFTER_ROW: [f64; 2 * LANES] = {
    let mut after = [0.0; 2 * LANES];
    let mut lane = LANES;
    while lane < 2 * LANES {
        after[lane] = f64::NAN;
        lane += 1;
    }
    after
};

/// Below so many columns and rows from corner to corner, a face is small: its edges are looked up.
const SMALL: usize = 16;

/// `FLOORS[columns + SMALL][rows][row]`: how many columns an edge of `columns` over `rows` has gone east after `row` rows, rounded down.
static FLOORS: [[[i8; SMALL]; SMALL]; 2 * SMALL] = {
    let mut floors = [[[0; SMALL]; SMALL]; 2 * SMALL];
    let mut columns = 1;
    while columns < 2 * SMALL {
        let mut rows = 1;
        while rows < SMALL {
            let mut row = 0;
            while row <= rows {
                let across = (columns as i32 - SMALL as i32) * row as i32;
                floors[columns][rows][row] = across.div_euclid(rows as i32) as i8;
                row += 1;
            }
            rows += 1;
        }
        columns += 1;
    }
    floors
};

/// What faces are scanned against.
pub(crate) struct FaceScan {
    /// NaN where no vertex is allowed: comparisons with NaN are false. After the last node come `LANES` more, so that all lanes
    /// can be read from any node.
    heights_m: Vec<f32>,
    columns: usize,
    max_error_m: f64,
    quantum_m: f64,
}

impl FaceScan {
    pub(crate) fn new(tile: &TileRaster<'_>, max_error_m: f64, quantum_m: f64) -> Self {
        let mut heights_m = tile.inner_heights_m();
        heights_m.resize(heights_m.len() + LANES, f32::NAN);
        Self { heights_m, columns: tile.columns(), max_error_m, quantum_m }
    }

    /// The node farthest from the plane through `corners` and its error in metres, if that is more than allowed. Of equals the
    /// first. Corners are counter-clockwise in columns and rows.
    ///
    /// Nodes on edges count for the faces on both sides. If one face left them to the other, the same nodes would be inserted, but not
    /// always in the same order: the queue compares errors as `f32`, and of two in one face that are equal so, only one is a candidate.
    pub(crate) fn worst_node(&self, corners: [Node; 3]) -> Option<(f64, u32)> {
        let at = corners.map(|node| [i32::from(node.column), i32::from(node.row)]);
        let [a, b, c] = at.map(|corner| corner.map(i64::from));
        let (ab, ac) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let double_area = ab[0] * ac[1] - ab[1] * ac[0];
        // Pick's theorem: 2 · area = 2 · nodes inside + nodes on the boundary − 2. At 1 there are but three.
        if double_area <= 1 {
            return None;
        }
        let [a_m, b_m, c_m] = corners.map(|node| f64::from(node.height_q) * self.quantum_m);
        // Everything is multiplied by twice the area: heights have few binary digits and areas are integers, so every
        // product and sum below is exact, and a node exactly at the tolerance is left out on every machine.
        let scale = double_area as f64;
        let (ab_m, ac_m) = (b_m - a_m, c_m - a_m);
        let per_column = ab_m * ac[1] as f64 - ac_m * ab[1] as f64;
        let per_row = ac_m * ab[0] as f64 - ab_m * ac[0] as f64;
        let plane = Plane { scale, per_column };
        let from_m = a_m * scale;

        let (mut worst_scaled, mut worst_row) = (self.max_error_m * scale, None);
        let mut look = |row: i32, first: i32, last: i32| {
            if last < first {
                return;
            }
            let in_row = from_m
                + per_row * f64::from(row - at[0][1])
                + per_column * f64::from(first - at[0][0]);
            let from = row as usize * self.columns + first as usize;
            let nodes = (last - first) as usize + 1;
            let scaled = self.most_in_row(from, nodes, in_row, &plane);
            if scaled > worst_scaled {
                worst_scaled = scaled;
                worst_row = Some((from, nodes, in_row));
            }
        };
        let sorted = from_north(corners);
        let [west, east] =
            [at[0][0].min(at[1][0]).min(at[2][0]), at[0][0].max(at[1][0]).max(at[2][0])];
        if east - west < SMALL as i32 && sorted[2][1] - sorted[0][1] < SMALL as i32 {
            for_each_row_of_small(sorted, look);
        } else {
            for_each_row([a, b, c], i64::MIN..=i64::MAX, |row, first, last| {
                look(row as i32, first as i32, last as i32);
            });
        }

        let (from, nodes, in_row) = worst_row?;
        // The same numbers as when the row was looked at, so one of them is equal.
        let is_worst = |&(step, &height_m): &(u32, &f32)| {
            plane.distance(height_m, in_row, f64::from(step)) >= worst_scaled
        };
        let (step, _) = (0..).zip(&self.heights_m[from..from + nodes]).find(is_worst)?;
        Some((worst_scaled / scale, from as u32 + step))
    }

    /// The largest distance of `nodes` nodes of a row, times the plane's scale. `in_row` is the plane at the first, `from`.
    #[inline]
    fn most_in_row(&self, mut from: usize, nodes: usize, in_row: f64, plane: &Plane) -> f64 {
        let mut left = nodes;
        let mut steps = [0.0, 1.0, 2.0, 3.0];
        let mut most = [0.0_f64; LANES];
        while let Some(heights_m) = self.heights_m[from..].first_chunk::<LANES>() {
            let after_row = &AFTER_ROW[LANES.saturating_sub(left)..][..LANES];
            for lane in 0..LANES {
                let scaled = plane.distance(heights_m[lane], in_row, steps[lane]) + after_row[lane];
                // Written so, and not with `max`, it is one instruction for all lanes; NaN is never larger.
                most[lane] = if scaled > most[lane] { scaled } else { most[lane] };
            }
            if left <= LANES {
                break;
            }
            left -= LANES;
            from += LANES;
            steps = steps.map(|step| step + LANES as f64);
        }
        most.into_iter().fold(0.0, |most, scaled| if scaled > most { scaled } else { most })
    }
}

/// The plane through a face, times `scale`.
struct Plane {
    scale: f64,
    per_column: f64,
}

impl Plane {
    /// How far a height is from the plane, times `scale`, `steps` columns east of a node where the plane is at `in_row`.
    #[inline]
    fn distance(&self, height_m: f32, in_row: f64, steps: f64) -> f64 {
        (f64::from(height_m) * self.scale - (in_row + self.per_column * steps)).abs()
    }
}

/// Corners from north to south, of the same row from west to east; without a branch, as no order is more likely.
#[inline]
fn from_north(corners: [Node; 3]) -> [[i32; 2]; 3] {
    let [p, q, r] = corners.map(|node| u32::from(node.row) << 16 | u32::from(node.column));
    let (first, last) = (p.min(q).min(r), p.max(q).max(r));
    [first, p ^ q ^ r ^ first ^ last, last]
        .map(|key| [key as u16, (key >> 16) as u16].map(i32::from))
}

/// Calls `each(row, first_column, last_column)` for the rows of a small face, from north to south: with all nodes that it holds, those on
/// its edges too, but without its northernmost and southernmost corner where one is alone in its row. Corners come as from [`from_north`].
///
/// ```text
///        a            In every row the face lies between the long edge a–c and one of the two
///        │ ╲          short ones, in that of b either.
///        │   b
///        │ ╱
///        c
/// ```
#[inline]
fn for_each_row_of_small([a, b, c]: [[i32; 2]; 3], mut each: impl FnMut(i32, i32, i32)) {
    let b_is_east = (b[0] - a[0]) * (c[1] - a[1]) > (c[0] - a[0]) * (b[1] - a[1]);
    // Columns are rounded into the face: up in the west, which is the negative of rounding the negative down.
    let long_sign = if b_is_east { -1 } else { 1 };
    let long = floors(a, c, long_sign);
    let (upper, lower) = (floors(a, b, -long_sign), floors(b, c, -long_sign));
    let first_row = a[1] + i32::from(a[1] != b[1]);
    let last_row = c[1] - i32::from(b[1] != c[1]);
    for row in first_row..=last_row {
        let (from, edge) = if row < b[1] { (a, upper) } else { (b, lower) };
        let long = a[0] + long_sign * i32::from(long[(row - a[1]) as usize % SMALL]);
        let short = from[0] - long_sign * i32::from(edge[(row - from[1]) as usize % SMALL]);
        if b_is_east { each(row, long, short) } else { each(row, short, long) }
    }
}

/// How far an edge of a small face has gone east, by row; west if `sign` is −1.
#[inline]
fn floors(from: [i32; 2], to: [i32; 2], sign: i32) -> &'static [i8; SMALL] {
    let (columns, rows) = (sign * (to[0] - from[0]) + SMALL as i32, to[1] - from[1]);
    &FLOORS[columns as usize % (2 * SMALL)][rows as usize % SMALL]
}

#[cfg(test)]
#[path = "face_scan_tests.rs"]
mod tests;
