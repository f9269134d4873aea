//! Finds the node of a face that is farthest from it.

use crate::TinVertex;
use crate::half_edges::Farthest;
use crate::lanes::{AFTER_ROW, LANES, Lanes, STEPS, lanes, less};
use crate::tile_raster::TileRaster;
use crate::triangle_rows::for_each_row;

/// The heights against which faces are scanned.
pub(crate) struct FaceScan {
    /// NaN where no vertex is allowed: comparisons with NaN are false. `LANES` more values follow
    /// the last node, so that all lanes can be read from any node.
    heights_m: Vec<f32>,
    columns: usize,
    max_error_m: f64,
    /// The first 32-bit float that exceeds the tolerance.
    beyond_m: f32,
    quantum_m: f64,
}

/// A face that is being scanned, with the plane through it. Heights of the plane are relative to
/// `base_m`, so that they are small.
struct Scanned {
    /// Counter-clockwise in columns and rows.
    corners: [[i32; 2]; 3],
    double_area: i64,
    base_m: f32,
    /// The plane's height at the first corner.
    first_m: f64,
    per_column_m: f64,
    per_row_m: f64,
}

/// Rows and columns that may contain nodes of a face, both ends included.
struct Window {
    columns: [i32; 2],
    rows: [i32; 2],
}

/// Faces of at most this many rows and columns are scanned in blocks of all their rows.
const SMALL: i32 = 16;

/// The lowest bits of a distance in a block, which encode its position there: from all bits set
/// downwards, row by row.
const PLACE_BITS: u32 = (SMALL as usize * LANES) as u32 - 1;

/// The largest error of a distance in 32-bit floats, relative to the greatest height that occurs
/// during its computation.
///
/// A float rounds to 2^-24 of itself. The plane's height, its start, slopes, products and sums are
/// rounded: twice per row and twice per four columns in a block, and six more times, which is at
/// most 46 times. The distance is rounded three times, relative to the same height, and the bits of
/// its position are 2^-17 of it, as much as 128 roundings. All together are less than 2^8 · 2^-24.
const DOUBT: f64 = 1.0 / (1 << 16) as f64;

/// Heights above this could overflow 32-bit floats.
const FLOATS_REACH_M: f64 = 1e30;

impl FaceScan {
    pub(crate) fn new(tile: &TileRaster<'_>, max_error_m: f64, quantum_m: f64) -> Self {
        let mut heights_m = tile.inner_heights_m();
        heights_m.resize(heights_m.len() + LANES, f32::NAN);
        let nearest_m = max_error_m as f32;
        let beyond_m =
            if f64::from(nearest_m) > max_error_m { nearest_m } else { nearest_m.next_up() };
        Self { heights_m, columns: tile.columns(), max_error_m, beyond_m, quantum_m }
    }

    /// The smallest distance that exceeds the tolerance.
    pub(crate) fn beyond_m(&self) -> f32 {
        self.beyond_m
    }

    /// Returns the node in the face, edges included, that is farthest from the plane through
    /// `corners`, as far as 32-bit floats can distinguish. Corners are counter-clockwise in columns
    /// and rows.
    ///
    /// Whether the node exceeds the tolerance is decided exactly: if rounding could matter, the
    /// face is scanned again by [`farthest_exactly`](Self::farthest_exactly).
    #[inline]
    pub(crate) fn farthest_node(&self, corners: [TinVertex; 3]) -> Farthest {
        let [a, b, c] = [place(corners[0]), place(corners[1]), place(corners[2])];
        let (ab, ac) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let double_area = cross(ab, ac);
        // Pick's theorem: 2 · area = 2 · nodes inside + nodes on the boundary − 2. If twice the
        // area is 1, there are only three nodes.
        if double_area <= 1 {
            return Farthest::default();
        }
        let height_m = |k: usize| f64::from(corners[k].height_q) * self.quantum_m;
        let a_m = height_m(0);
        let (ab_m, ac_m) = (height_m(1) - a_m, height_m(2) - a_m);
        let inverse = 1.0 / double_area as f64;
        let base_m = a_m as f32;
        let face = Scanned {
            corners: [a, b, c],
            double_area,
            base_m,
            first_m: a_m - f64::from(base_m),
            per_column_m: (ab_m * f64::from(ac[1]) - ac_m * f64::from(ab[1])) * inverse,
            per_row_m: (ac_m * f64::from(ab[0]) - ab_m * f64::from(ac[0])) * inverse,
        };
        let window = Window { columns: ends([a[0], b[0], c[0]]), rows: ends([a[1], b[1], c[1]]) };
        let [columns, rows] = [window.columns, window.rows].map(|[first, last]| last - first + 1);
        let (far_m, node) = if columns <= SMALL && rows <= SMALL {
            self.farthest_of_small(&face, &window)
        } else {
            self.farthest_by_rows(&face)
        };
        let reach_m = face.per_column_m.abs() * f64::from(columns + 2)
            + face.per_row_m.abs() * f64::from(rows + 2)
            + self.max_error_m;
        // Floats below the smallest positive normal one have fewer bits.
        let doubt_m = (reach_m + f64::from(f32::MIN_POSITIVE)) * DOUBT;
        let certain = ((f64::from(far_m) - self.max_error_m).abs() > doubt_m)
            & (reach_m + a_m.abs() < FLOATS_REACH_M);
        if certain { Farthest { far_m, node } } else { self.farthest_exactly(corners) }
    }

    /// Returns the farthest node of a small face. Every edge and the plane are functions of the
    /// node that grow by a fixed amount from row to row; a node is in the face if the functions of
    /// all three edges are at least 0.
    #[inline]
    fn farthest_of_small(&self, face: &Scanned, window: &Window) -> (f32, u32) {
        let ([west, east], [north, south]) = (window.columns, window.rows);
        let [a, b, c] = face.corners;
        let start_m = face.first_m
            + face.per_column_m * f64::from(west - a[0])
            + face.per_row_m * f64::from(north - a[1]);
        let mut block = ColumnBlock {
            ab: Growing::of_edge(a, b, [west, north]),
            bc: Growing::of_edge(b, c, [west, north]),
            plane_m: Growing::new(start_m as f32, face.per_column_m as f32, face.per_row_m as f32),
            double_area: [face.double_area as f32; LANES],
            base_m: [face.base_m; LANES],
            rows: (south - north + 1) as u32,
        };
        let (mut farthest, mut farthest_in) = (0.0, 0);
        let mut first = north as usize * self.columns + west as usize;
        let mut left = east - west + 1;
        while left > 0 {
            let [p, q, r, s] = self.farthest_in_block(first, &block);
            let (p, q) = (if q > p { q } else { p }, if s > r { s } else { r });
            let most = if q > p { q } else { p };
            farthest_in = if most > farthest { first } else { farthest_in };
            farthest = if most > farthest { most } else { farthest };
            for growing in [&mut block.ab, &mut block.bc, &mut block.plane_m] {
                let column = growing.column;
                growing.column = lanes(|lane| column[lane] + growing.next_columns[lane]);
            }
            first += LANES;
            left -= LANES as i32;
        }
        let code = (PLACE_BITS - (farthest.to_bits() & PLACE_BITS)) as usize;
        (farthest, (farthest_in + code / LANES * self.columns + code % LANES) as u32)
    }

    /// Returns the greatest distances of the nodes of a block that are in the face, in each lane.
    /// `first` is the block's first node.
    ///
    /// This is a separate function because the compiler would split the lanes if it were inlined
    /// together with the code that uses its result.
    #[inline(never)]
    fn farthest_in_block(&self, first: usize, block: &ColumnBlock) -> Lanes {
        let ColumnBlock { ab, bc, plane_m, .. } = block;
        let mut left_of_ab = ab.column;
        let mut left_of_bc = bc.column;
        let mut in_plane_m = plane_m.column;
        let mut most: Lanes = [0.0; LANES];
        let mut from = first;
        let mut codes = [PLACE_BITS, PLACE_BITS - 1, PLACE_BITS - 2, PLACE_BITS - 3];
        for _ in 0..block.rows {
            let Some(heights_m) = self.heights_m[from..].first_chunk::<LANES>() else { break };
            let far = lanes(|lane| heights_m[lane] - block.base_m[lane] - in_plane_m[lane]);
            let far = lanes(|lane| {
                f32::from_bits(far[lane].to_bits() & !(PLACE_BITS | 1 << 31) | codes[lane])
            });
            let left_of_ca =
                lanes(|lane| block.double_area[lane] - left_of_ab[lane] - left_of_bc[lane]);
            let inside = less(less(left_of_ab, left_of_bc), left_of_ca);
            let far = lanes(|lane| if inside[lane] >= 0.0 { far[lane] } else { 0.0 });
            most = lanes(|lane| if far[lane] > most[lane] { far[lane] } else { most[lane] });
            left_of_ab = lanes(|lane| left_of_ab[lane] + ab.per_row[lane]);
            left_of_bc = lanes(|lane| left_of_bc[lane] + bc.per_row[lane]);
            in_plane_m = lanes(|lane| in_plane_m[lane] + plane_m.per_row[lane]);
            for code in &mut codes {
                *code = code.wrapping_sub(LANES as u32);
            }
            from += self.columns;
        }
        most
    }

    /// Returns the farthest node of any face, row by row.
    fn farthest_by_rows(&self, face: &Scanned) -> (f32, u32) {
        let [a, ..] = face.corners;
        let per_column_m = face.per_column_m as f32;
        let corners = face.corners.map(|corner| corner.map(i64::from));
        let mut farthest = InLanes { most: [0.0; LANES], places: [0.0; LANES] };
        for_each_row(corners, i64::MIN..=i64::MAX, |row, first, last| {
            if last < first {
                return;
            }
            let start_m = face.first_m
                + face.per_row_m * (row - i64::from(a[1])) as f64
                + face.per_column_m * (first - i64::from(a[0])) as f64;
            let from = row as usize * self.columns + first as usize;
            let nodes = (last - first + 1) as usize;
            let in_row = InRow { start_m: start_m as f32, per_column_m, base_m: face.base_m };
            self.look_at_row(from, nodes, &in_row, &mut farthest);
        });
        let InLanes { most, places } = farthest;
        let mut farthest = (0.0, 0);
        for lane in 0..LANES {
            let node = places[lane].to_bits() + lane as u32;
            if most[lane] > farthest.0 || (most[lane] >= farthest.0 && node < farthest.1) {
                farthest = (most[lane], node);
            }
        }
        farthest
    }

    /// Compares the nodes of a row, from node `from` on, with the farthest so far. It is a separate
    /// function for the same reason.
    #[inline(never)]
    fn look_at_row(&self, mut from: usize, nodes: usize, in_row: &InRow, farthest: &mut InLanes) {
        let &InRow { start_m, per_column_m, base_m } = in_row;
        let InLanes { mut most, mut places } = *farthest;
        let mut left = nodes;
        let mut steps = STEPS;
        while let Some(heights_m) = self.heights_m[from..].first_chunk::<LANES>() {
            let after_row = &AFTER_ROW[LANES.saturating_sub(left)..][..LANES];
            let far = lanes(|lane| {
                let plane_m = start_m + per_column_m * steps[lane];
                (heights_m[lane] - base_m - plane_m).abs() + after_row[lane]
            });
            let here = f32::from_bits(from as u32);
            places = lanes(|lane| if far[lane] > most[lane] { here } else { places[lane] });
            most = lanes(|lane| if far[lane] > most[lane] { far[lane] } else { most[lane] });
            if left <= LANES {
                break;
            }
            steps = lanes(|lane| steps[lane] + LANES as f32);
            from += LANES;
            left -= LANES;
        }
        *farthest = InLanes { most, places };
    }

    /// Returns the farthest node (the first among equal ones) if it exceeds the tolerance: without
    /// any rounding, and slower.
    #[cold]
    #[inline(never)]
    fn farthest_exactly(&self, corners: [TinVertex; 3]) -> Farthest {
        let [a, b, c] = corners.map(place);
        let (ab, ac) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let [a_m, b_m, c_m] = corners.map(|corner| f64::from(corner.height_q) * self.quantum_m);
        // Everything is multiplied by twice the area: heights have few binary digits and areas are
        // integers, so every product and sum below is exact, and a node exactly at the tolerance is
        // accepted on every machine.
        let scale = cross(ab, ac) as f64;
        let (ab_m, ac_m) = (b_m - a_m, c_m - a_m);
        let per_column = ab_m * f64::from(ac[1]) - ac_m * f64::from(ab[1]);
        let per_row = ac_m * f64::from(ab[0]) - ab_m * f64::from(ac[0]);
        let mut worst = (self.max_error_m * scale, None);
        for_each_row(
            [a, b, c].map(|at| at.map(i64::from)),
            i64::MIN..=i64::MAX,
            |row, first, last| {
                let in_row = a_m * scale + per_row * (row - i64::from(a[1])) as f64;
                for column in first..=last {
                    let node = row as usize * self.columns + column as usize;
                    let plane = in_row + per_column * (column - i64::from(a[0])) as f64;
                    let scaled = (f64::from(self.heights_m[node]) * scale - plane).abs();
                    if scaled > worst.0 {
                        worst = (scaled, Some(node as u32));
                    }
                }
            },
        );
        worst.1.map_or(Farthest::default(), |node| {
            let far_m = (worst.0 / scale) as f32;
            Farthest { far_m: if far_m > self.beyond_m { far_m } else { self.beyond_m }, node }
        })
    }
}

/// A number that grows linearly from node to node: its values in the first row of a block's
/// columns, and its increments for the next row and for the next block.
struct Growing {
    column: Lanes,
    per_row: Lanes,
    next_columns: Lanes,
}

impl Growing {
    #[inline]
    fn new(start: f32, per_column: f32, per_row: f32) -> Self {
        Self {
            column: lanes(|lane| start + per_column * STEPS[lane]),
            per_row: [per_row; LANES],
            next_columns: [per_column * LANES as f32; LANES],
        }
    }

    /// The side of the edge from `p` to `q` on which nodes are, from the node `start` on: more than
    /// 0 to its left, 0 on it. The values are whole numbers below 2^24, because edges are short.
    #[inline]
    fn of_edge(p: [i32; 2], q: [i32; 2], start: [i32; 2]) -> Self {
        let (per_column, per_row) = (p[1] - q[1], q[0] - p[0]);
        let start = per_column * (start[0] - p[0]) + per_row * (start[1] - p[1]);
        Self::new(start as f32, per_column as f32, per_row as f32)
    }
}

/// The farthest nodes so far in each lane: the distance, and the index of the first lane's node as
/// the bits of a float, because numbers of one type stay in the same registers.
struct InLanes {
    most: Lanes,
    places: Lanes,
}

/// The plane along a row.
#[expect(clippy::struct_field_names, reason = "all are metres")]
struct InRow {
    start_m: f32,
    per_column_m: f32,
    base_m: f32,
}

/// The columns of a small face, as many as there are lanes.
struct ColumnBlock {
    ab: Growing,
    bc: Growing,
    plane_m: Growing,
    /// The sum of the three edge functions, which is the same everywhere.
    double_area: Lanes,
    base_m: Lanes,
    rows: u32,
}

#[inline]
fn place(corner: TinVertex) -> [i32; 2] {
    [i32::from(corner.column), i32::from(corner.row)]
}

#[inline]
fn cross(p: [i32; 2], q: [i32; 2]) -> i64 {
    i64::from(p[0]) * i64::from(q[1]) - i64::from(p[1]) * i64::from(q[0])
}

/// Returns the first and the last of three columns or rows, without those that contain only a
/// corner of the face.
#[inline]
fn ends([a, b, c]: [i32; 3]) -> [i32; 2] {
    let (first, last) = (a.min(b).min(c), a.max(b).max(c));
    let is_one =
        |end: i32| i32::from(i32::from(a == end) + i32::from(b == end) + i32::from(c == end) == 1);
    [first + is_one(first), last - is_one(last)]
}

#[cfg(test)]
#[path = "face_scan_tests.rs"]
mod tests;
