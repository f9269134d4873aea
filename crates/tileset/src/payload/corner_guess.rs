//! Vertices as nodes of a tile's grid, and the search for the corner that a Delaunay triangulation
//! would choose.

use corniche_geom::TILE_NODES;

use crate::payload::{
    near_corners::{MARGIN, NearCorners, NearNode, STRIDE},
    work_limit::StepBudget,
};

/// Vertices of a tile's grid, sorted by row, then column.
#[derive(Debug)]
pub(crate) struct GridVertices<'w> {
    /// Column and row.
    at: Vec<[i32; 2]>,
    grid: Box<Grid>,
    near_corners: &'static NearCorners,
    work: &'w StepBudget,
}

/// An index from nodes to vertices.
#[derive(Debug)]
struct Grid {
    /// A bit for each node, row by row, in groups of 64, with the westernmost node of a group in
    /// its lowest bit. Rows are [`STRIDE`] bits apart, and there are [`MARGIN`] nodes without a
    /// vertex on every side.
    groups: [u64; GROUPS],
    /// The number of vertices before each group.
    before: [u32; GROUPS],
}

/// The number of groups of 64 nodes: a power of two, so that an index modulo this number needs no
/// bounds check.
const GROUPS: usize = ((TILE_NODES + 2 * MARGIN) * STRIDE).div_ceil(64).next_power_of_two();

/// The index of the bit of a node.
#[inline]
fn place(column: i32, row: i32) -> usize {
    (row as usize + MARGIN) * STRIDE + column as usize + MARGIN
}

impl Grid {
    /// Creates the index; `at` as in [`GridVertices::new`].
    fn new(at: &[[i32; 2]]) -> Self {
        let mut groups = [0_u64; GROUPS];
        for &[column, row] in at {
            let place = place(column, row);
            groups[place / 64] |= 1 << (place % 64);
        }
        let mut before = [0; GROUPS];
        let mut count = 0;
        for (before, group) in before.iter_mut().zip(groups) {
            *before = count;
            count += group.count_ones();
        }
        Self { groups, before }
    }

    /// Whether the node at an index has a vertex.
    #[inline]
    fn has_vertex(&self, place: usize) -> bool {
        self.groups[place / 64 % GROUPS] >> (place % 64) & 1 == 1
    }

    /// The vertex of a node that has one.
    #[inline]
    fn vertex(&self, place: usize) -> u32 {
        let group = place / 64 % GROUPS;
        let west = self.groups[group] & ((1 << (place % 64)) - 1);
        self.before[group] + west.count_ones()
    }

    /// The 64 nodes from an index on as bits: 1 for nodes with a vertex, the first node in the
    /// lowest bit.
    #[inline]
    fn from(&self, place: usize) -> u64 {
        let (group, shift) = (place / 64, place % 64);
        let here = self.groups[group % GROUPS] >> shift;
        here | (self.groups[(group + 1) % GROUPS] << 1) << (63 - shift)
    }
}

/// The number of the last column and of the last row.
const LAST: i32 = TILE_NODES as i32 - 1;

/// This many examined nodes of a list count as a step of the walk: they take as long as a row.
const NODES_OF_A_STEP: usize = 16;

/// Marks the limit of a search before any vertex is found.
const NO_VERTEX: u32 = u32::MAX;

/// The best corner of a gate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct GateCorner {
    pub vertex: u32,
    /// Whether another vertex sees the gate under the same angle, which means that it is on the
    /// same circle.
    pub is_tied: bool,
    /// The cotangent of the angle is dot / cross; cross is positive.
    pub dot: i64,
    pub cross: i64,
}

impl<'w> GridVertices<'w> {
    /// Creates the vertices from columns and rows below [`TILE_NODES`], sorted by row, then column.
    /// Searches count as `work`.
    pub(crate) fn new(at: impl Iterator<Item = [u16; 2]>, work: &'w StepBudget) -> Self {
        let at: Vec<[i32; 2]> = at.map(|node| node.map(i32::from)).collect();
        let grid = Box::new(Grid::new(&at));
        Self { at, grid, near_corners: NearCorners::get(), work }
    }

    /// How the corner d to the right of a ► b sees this gate: dot and cross, which is positive. For
    /// a corner on the left, cross is negative.
    pub(crate) fn behind(&self, [a, b, d]: [u32; 3]) -> [i64; 2] {
        let [[ac, ar], [bc, br], [dc, dr]] =
            [a, b, d].map(|vertex| self.at[vertex as usize].map(i64::from));
        let dot = (ac - dc) * (bc - dc) + (ar - dr) * (br - dr);
        [dot, (bc - ac) * (dr - ar) + (ar - br) * (dc - ac)]
    }

    /// The square of an edge's length.
    pub(crate) fn length_squared(&self, [a, b]: [u32; 2]) -> i64 {
        let ([ac, ar], [bc, br]) = (self.at[a as usize], self.at[b as usize]);
        i64::from((ac - bc) * (ac - bc) + (ar - br) * (ar - br))
    }

    pub(crate) fn len(&self) -> usize {
        self.at.len()
    }

    /// The budget that searches are counted in.
    pub(crate) fn work(&self) -> &'w StepBudget {
        self.work
    }

    /// Finds the allowed vertex strictly to the left of a ► b that sees it under the largest angle;
    /// of several vertices the one with the smallest index.
    #[inline]
    pub(crate) fn best_corner(
        &self,
        [a, b]: [u32; 2],
        allowed: impl Fn(u32) -> bool,
    ) -> Option<GateCorner> {
        let ends = [a, b].map(|vertex| self.at[vertex as usize]);
        let [[ac, ar], [bc, br]] = ends;
        let near = self.near_corners.near([bc - ac, br - ar]);
        let origin = place(ac, ar);
        let vertex_of = |node: &NearNode| {
            let place = origin.wrapping_add_signed(node.offset());
            self.grid.has_vertex(place).then(|| self.grid.vertex(place))
        };
        let mut found = None;
        for (number, node) in near.iter().enumerate() {
            if let Some(vertex) = vertex_of(node).filter(|&vertex| allowed(vertex)) {
                found = Some((number, vertex));
                break;
            }
        }
        let Some((number, vertex)) = found else {
            self.work.add(1 + near.len() / NODES_OF_A_STEP);
            if is_on_rim(ends) {
                return None;
            }
            return self.far_corner(ends, allowed);
        };
        self.work.add(1 + number / NODES_OF_A_STEP);
        let mut is_tied = false;
        for pair in near[number..].windows(2) {
            if is_tied || !pair[0].ties_with_next() {
                break;
            }
            is_tied = vertex_of(&pair[1]).is_some_and(&allowed);
        }
        let [dot, cross] = self.behind([a, b, vertex]);
        Some(GateCorner { vertex, is_tied, dot, cross: -cross })
    }

    /// Finds the corner without the lists of near nodes.
    ///
    /// Rows are searched outwards from the gate until they leave a box around the circle through
    /// the best vertex so far. Floating point only limits the search, by more than its error;
    /// decisions are exact.
    #[inline(never)]
    fn far_corner(
        &self,
        [a, b]: [[i32; 2]; 2],
        allowed: impl Fn(u32) -> bool,
    ) -> Option<GateCorner> {
        let gate = Gate::new(a, b);
        // Nearly every corner sees its gate under more than 27° or 4°: search small circles before
        // the half-plane.
        let found = [Some(2), Some(16), None].into_iter().find_map(|limit_cot| {
            let mut best = Best::within(limit_cot, &gate);
            let steps = self.search(&gate, &allowed, &mut best);
            self.work.add(steps);
            (best.vertex != NO_VERTEX).then_some(best)
        });
        found.map(|Best { vertex, is_tied, dot, cross, .. }| GateCorner {
            vertex,
            is_tied,
            dot: i64::from(dot),
            cross: i64::from(cross),
        })
    }

    /// Searches for vertices better than `best`; returns the number of steps taken: rows and
    /// vertices.
    fn search(&self, gate: &Gate, allowed: &impl Fn(u32) -> bool, best: &mut Best) -> usize {
        let mut steps = 0;
        let middle = i32::midpoint(gate.a[1], gate.b[1]);
        // First search the side where the vertex is, then the other side.
        let ahead = if gate.dx > 0 { -1 } else { 1 };
        for (mut row, step) in [(middle, ahead), (middle - ahead, -ahead)] {
            // The box extends to the middle of the gate or beyond.
            while row >= best.rows[0] && row <= best.rows[1] {
                steps += 1 + self.search_row(row, gate, allowed, best);
                row += step;
            }
        }
        steps
    }

    #[inline]
    fn search_row(
        &self,
        row: i32,
        gate: &Gate,
        allowed: &impl Fn(u32) -> bool,
        best: &mut Best,
    ) -> usize {
        let Gate { a: [ac, ar], b: [bc, br], dx, dy, .. } = *gate;
        let [low, high] = gate.columns_on_left(row);
        let (mut low, high) = (low.max(best.columns[0]), high.min(best.columns[1]));
        let cross_in_row = dx * (ar - row) + dy * ac;
        let dot_in_row = (ar - row) * (br - row);
        let mut looked_at = 0;
        while low <= high {
            let mut left = self.grid.from(place(low, row));
            left &= u64::MAX >> (63 - (high - low).min(63));
            while left != 0 {
                let column = low + left.trailing_zeros() as i32;
                left &= left - 1;
                looked_at += 1;
                let cross = cross_in_row - dy * column;
                let dot = (ac - column) * (bc - column) + dot_in_row;
                let [new, old] = [
                    i64::from(dot) * i64::from(best.cross),
                    i64::from(best.dot) * i64::from(cross),
                ];
                if cross > 0 && new <= old {
                    let vertex = self.grid.vertex(place(column, row));
                    if allowed(vertex) {
                        best.take(vertex, [dot, cross], new == old, gate);
                    }
                }
            }
            low += 64;
        }
        looked_at
    }
}

/// Whether a gate is on the border of the grid and has no nodes on its left.
fn is_on_rim([[ac, ar], [bc, br]]: [[i32; 2]; 2]) -> bool {
    (ar == br && (ar == 0 && ac < bc || ar == LAST && ac > bc))
        || (ac == bc && (ac == 0 && ar > br || ac == LAST && ar < br))
}

/// A directed edge a ► b.
struct Gate {
    /// Column and row.
    a: [i32; 2],
    b: [i32; 2],
    /// The vector from a to b; y grows upwards, against the row.
    dx: i32,
    dy: i32,
    /// The number of columns by which the edge's line moves east per row to the north, times 2^32,
    /// rounded.
    slope: i64,
}

impl Gate {
    fn new(a: [i32; 2], b: [i32; 2]) -> Self {
        let (dx, dy) = (b[0] - a[0], a[1] - b[1]);
        let slope = if dy == 0 { 0 } else { (i64::from(dx) << 32) / i64::from(dy) };
        Self { a, b, dx, dy, slope }
    }

    /// The first and the last column of a row that can contain nodes strictly to the left of the
    /// edge; the row may contain none, or the range may have one column too many.
    ///
    /// The line meets the row at a whole number of columns, where nodes are on the line, or at a
    /// distance of at least 1/256 from it: the slope's error, at most 2^−24 over all rows, does not
    /// matter.
    #[inline]
    fn columns_on_left(&self, row: i32) -> [i32; 2] {
        let north = self.a[1] - row;
        let line = self.a[0] + ((i64::from(north) * self.slope) >> 32) as i32;
        match self.dy.signum() {
            1 => [0, line.min(LAST)],
            -1 => [line.max(0), LAST],
            _ if self.dx * north > 0 => [0, LAST],
            _ => [1, 0],
        }
    }
}

/// The best vertex so far and how it sees the gate: the cotangent of the angle is dot / cross. Or
/// the limit of a search, with the vertex [`NO_VERTEX`].
struct Best {
    vertex: u32,
    is_tied: bool,
    dot: i32,
    cross: i32,
    /// The first and the last column, and the first and the last row, of a box around the circle
    /// through the gate and the vertex, within the grid.
    columns: [i32; 2],
    rows: [i32; 2],
}

impl Best {
    /// Begins a search for vertices that see the gate under an angle with at most this cotangent.
    fn within(limit_cot: Option<i32>, gate: &Gate) -> Self {
        let whole = [0, LAST];
        // A vertex sees the gate under a cotangent of at most 2 · 256².
        let dot = limit_cot.unwrap_or(4 * LAST * LAST);
        let mut best =
            Self { vertex: NO_VERTEX, is_tied: false, dot, cross: 1, columns: whole, rows: whole };
        if limit_cot.is_some() {
            best.shrink_box(gate);
        }
        best
    }

    /// Takes a vertex that is better than the best one, or equally good (`is_equal`).
    #[inline]
    fn take(&mut self, vertex: u32, [dot, cross]: [i32; 2], is_equal: bool, gate: &Gate) {
        if is_equal && self.vertex != NO_VERTEX {
            self.is_tied = true;
            if vertex < self.vertex {
                (self.vertex, self.dot, self.cross) = (vertex, dot, cross);
            }
        } else {
            (self.vertex, self.dot, self.cross, self.is_tied) = (vertex, dot, cross, false);
            self.shrink_box(gate);
        }
    }

    /// Fits the box to the circle through a, b and the vertex, whose centre is cot / 2 gate lengths
    /// to the left of the gate's middle.
    #[inline]
    fn shrink_box(&mut self, &Gate { a, b, dx, dy, .. }: &Gate) {
        let half_cot = f64::from(self.dot) / f64::from(2 * self.cross);
        let (dx, dy) = (f64::from(dx), f64::from(dy));
        // The vector to the left of (dx, dy) is (−dy, dx); rows grow downwards.
        let center = [
            f64::from(a[0] + b[0]) / 2.0 - half_cot * dy,
            f64::from(a[1] + b[1]) / 2.0 - half_cot * dx,
        ];
        let radius = ((dx * dx + dy * dy) * (0.25 + half_cot * half_cot)).sqrt() * (1.0 + 1e-9);
        // The cast rounds towards 0, by less than a cell.
        let within =
            |at: f64| [((at - radius) as i32).max(0), ((at + radius) as i32 + 1).min(LAST)];
        [self.columns, self.rows] = center.map(within);
    }
}

#[cfg(test)]
#[path = "corner_guess_tests.rs"]
mod tests;
