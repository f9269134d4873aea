//! Vertices as nodes of a tile's grid, and the search for the corner that a Delaunay triangulation would take.

use std::cmp::Ordering;

use corniche_geom::TILE_NODES;

use crate::payload::work_limit::Work;

/// Vertices of a tile's grid, sorted by row, then column.
#[derive(Debug)]
pub(crate) struct Nodes<'w> {
    /// Column and row.
    at: Vec<[i64; 2]>,
    /// How many vertices come before each node, by row, then column.
    before: Vec<u32>,
    work: &'w Work,
}

/// Marks the limit of a search before any vertex is found.
const NO_VERTEX: u32 = u32::MAX;

/// The best corner of a gate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Corner {
    pub(crate) vertex: u32,
    /// Whether another vertex sees the gate under the same angle: it lies on the same circle.
    pub(crate) is_tied: bool,
    /// The cotangent of the angle is dot / cross; cross is positive.
    pub(crate) dot: i64,
    pub(crate) cross: i64,
}

/// A candidate and how it sees the gate: cot of the angle = dot / cross.
#[derive(Clone, Copy)]
struct Best {
    corner: Corner,
    /// First and last column and row of a box around the circle through the gate and the vertex.
    columns: [i64; 2],
    rows: [i64; 2],
}

impl<'w> Nodes<'w> {
    /// `at` holds columns and rows below [`TILE_NODES`], sorted by row, then column. Searches count as `work`.
    pub(crate) fn new(at: impl Iterator<Item = [u16; 2]>, work: &'w Work) -> Self {
        let at: Vec<[i64; 2]> = at.map(|node| node.map(i64::from)).collect();
        let mut before = Vec::with_capacity(TILE_NODES * TILE_NODES + 1);
        for (vertex, &[column, row]) in at.iter().enumerate() {
            before.resize(row as usize * TILE_NODES + column as usize + 1, vertex as u32);
        }
        before.resize(TILE_NODES * TILE_NODES + 1, at.len() as u32);
        Self { at, before, work }
    }

    /// How the corner on the right of a ► b sees this gate: dot and cross, which is positive.
    pub(crate) fn behind(&self, [a, b, d]: [u32; 3]) -> [i64; 2] {
        let [[ac, ar], [bc, br], [dc, dr]] = [a, b, d].map(|vertex| self.at[vertex as usize]);
        let dot = (ac - dc) * (bc - dc) + (ar - dr) * (br - dr);
        [dot, (bc - ac) * (dr - ar) + (ar - br) * (dc - ac)]
    }

    /// The square of an edge's length.
    pub(crate) fn length_squared(&self, [a, b]: [u32; 2]) -> i64 {
        let ([ac, ar], [bc, br]) = (self.at[a as usize], self.at[b as usize]);
        (ac - bc) * (ac - bc) + (ar - br) * (ar - br)
    }

    pub(crate) fn len(&self) -> usize {
        self.at.len()
    }

    /// What searches count as.
    pub(crate) fn work(&self) -> &'w Work {
        self.work
    }

    /// The allowed vertex strictly to the left of a ► b that sees it under the largest angle; of several the
    /// one with the smallest index.
    ///
    /// Rows are searched outwards from the gate until they leave a box around the circle through the best vertex so far. Floating
    /// point only bounds the search, by more than its error; decisions are exact. It gives up when the allowed work
    /// is used up; the caller checks this.
    pub(crate) fn best_corner(
        &self,
        gate: [u32; 2],
        allowed: impl Fn(u32) -> bool,
    ) -> Option<Corner> {
        // Nearly every corner sees its gate under more than 27° or 4°: try small circles before the half-plane.
        let within = |cot| self.best_corner_within(gate, cot, &allowed);
        within(Some(2)).or_else(|| within(Some(16))).or_else(|| within(None))
    }

    /// The same among vertices that see the gate under an angle with at most this cotangent.
    fn best_corner_within(
        &self,
        [a, b]: [u32; 2],
        limit_cot: Option<i64>,
        allowed: &impl Fn(u32) -> bool,
    ) -> Option<Corner> {
        let ([ac, ar], [bc, br]) = (self.at[a as usize], self.at[b as usize]);
        let middle = i64::midpoint(ar, br);
        let last_row = TILE_NODES as i64 - 1;
        let mut best = limit_cot.map(|dot| {
            let corner = Corner { vertex: NO_VERTEX, is_tied: false, dot, cross: 1 };
            circle(corner, [[ac, ar], [bc, br]])
        });
        for away in 0..=last_row {
            if self.work.is_too_much() {
                break;
            }
            let (north, south) = (middle - away, middle + away);
            let reach = |row: i64| {
                best.is_none_or(|Best { rows: [first, last], .. }| (first..=last).contains(&row))
            };
            let (go_north, go_south) =
                (north >= 0 && reach(north), away > 0 && south <= last_row && reach(south));
            // The box meets the gate's rows: once outside on both sides, always outside.
            if away > (ar - br).abs() && !go_north && !go_south {
                break;
            }
            for (row, go) in [(north, go_north), (south, go_south)] {
                if go {
                    self.search_row(row, [[ac, ar], [bc, br]], allowed, &mut best);
                }
            }
        }
        best.map(|best| best.corner).filter(|corner| corner.vertex != NO_VERTEX)
    }

    fn search_row(
        &self,
        row: i64,
        [[ac, ar], [bc, br]]: [[i64; 2]; 2],
        allowed: &impl Fn(u32) -> bool,
        best: &mut Option<Best>,
    ) {
        // x grows with the column, y against the row: left of a ► b means cross > 0.
        let (dx, dy) = (bc - ac, ar - br);
        let (mut low, mut high) = (0, TILE_NODES as i64 - 1);
        // cross = dx · (y − ay) − dy · (x − ax) with y − ay = ar − row.
        let lift = dx * (ar - row);
        match dy.signum() {
            0 if lift <= 0 => return,
            0 => {}
            1 => high = high.min(ac + lift.div_euclid(dy)),
            _ => low = low.max(ac + lift.div_euclid(dy)),
        }
        if let Some(Best { columns: [first, last], .. }) = *best {
            (low, high) = (low.max(first), high.min(last));
        }
        if low > high {
            return;
        }
        let first = self.before[row as usize * TILE_NODES + low as usize] as usize;
        let end = self.before[row as usize * TILE_NODES + high as usize + 1] as usize;
        for (vertex, &[c, r]) in (first..end).zip(&self.at[first..end]) {
            let cross = dx * (ar - r) - dy * (c - ac);
            if cross <= 0 {
                continue;
            }
            let dot = (ac - c) * (bc - c) + (ar - r) * (br - r);
            let vertex = vertex as u32;
            let than_best = best.map_or(Ordering::Less, |Best { corner, .. }| {
                (dot * corner.cross).cmp(&(corner.dot * cross))
            });
            if than_best == Ordering::Greater || !allowed(vertex) {
                continue;
            }
            let corner = Corner { vertex, is_tied: false, dot, cross };
            match best {
                Some(best) if than_best == Ordering::Equal => {
                    // The best so far may be the limit of the search, which is no vertex.
                    let is_tied = best.corner.vertex != NO_VERTEX;
                    best.corner = if vertex < best.corner.vertex { corner } else { best.corner };
                    best.corner.is_tied = is_tied;
                }
                _ => *best = Some(circle(corner, [[ac, ar], [bc, br]])),
            }
        }
        self.work.add(1 + end - first);
    }
}

/// The box around the circle through a, b and the corner: its centre is cot / 2 gate lengths to the left of the gate's middle.
fn circle(corner: Corner, [[ac, ar], [bc, br]]: [[i64; 2]; 2]) -> Best {
    let cot = corner.dot as f64 / corner.cross as f64;
    let (dx, dy) = ((bc - ac) as f64, (ar - br) as f64);
    // Left of (dx, dy) is (−dy, dx); rows grow downwards.
    let center = [(ac + bc) as f64 / 2.0 - cot / 2.0 * dy, (ar + br) as f64 / 2.0 - cot / 2.0 * dx];
    let radius = ((dx * dx + dy * dy) * (1.0 + cot * cot)).sqrt() / 2.0 * (1.0 + 1e-9);
    // Truncation is towards 0: less than a cell.
    let [columns, rows] = center.map(|at| [(at - radius) as i64 - 1, (at + radius) as i64 + 1]);
    Best { corner, columns, rows }
}

#[cfg(test)]
#[path = "corner_guess_tests.rs"]
mod tests;
