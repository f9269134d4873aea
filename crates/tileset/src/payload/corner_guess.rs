//! Vertices as nodes of a tile's grid, and the search for the corner that a Delaunay triangulation would take.

use corniche_geom::TILE_NODES;

use crate::payload::work_limit::Work;

/// Rows and columns of vertices sorted by row, then column.
#[derive(Debug)]
pub(crate) struct Nodes<'w> {
    /// Column and row.
    at: Vec<[i64; 2]>,
    /// Vertices of row r are `row_starts[r]..row_starts[r + 1]`.
    row_starts: Vec<u32>,
    work: &'w Work,
}

/// Marks the limit of a search before any vertex is found.
const NO_VERTEX: u32 = u32::MAX;

/// A candidate and how it sees the gate: cot of the angle = dot / cross.
#[derive(Clone, Copy)]
struct Best {
    vertex: u32,
    dot: i64,
    cross: i64,
    /// Circle through the gate and the vertex.
    center: [f64; 2],
    radius: f64,
}

impl<'w> Nodes<'w> {
    /// `at` holds columns and rows below [`TILE_NODES`], sorted by row, then column. Searches count as `work`.
    pub(crate) fn new(at: impl Iterator<Item = [u16; 2]>, work: &'w Work) -> Self {
        let at: Vec<[i64; 2]> = at.map(|node| node.map(i64::from)).collect();
        let row_starts = (0..=TILE_NODES as i64)
            .map(|row| at.partition_point(|node| node[1] < row) as u32)
            .collect();
        Self { at, row_starts, work }
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
    /// Rows are searched outwards from the gate until they leave the circle through the best vertex so far. Floating
    /// point only bounds the search, by more than its error; decisions are exact. It gives up when the allowed work
    /// is used up; the caller checks this.
    pub(crate) fn best_corner(&self, gate: [u32; 2], allowed: impl Fn(u32) -> bool) -> Option<u32> {
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
    ) -> Option<u32> {
        let ([ac, ar], [bc, br]) = (self.at[a as usize], self.at[b as usize]);
        let middle = i64::midpoint(ar, br);
        let last_row = TILE_NODES as i64 - 1;
        let mut best = limit_cot.map(|cot| circle(NO_VERTEX, cot, 1, [[ac, ar], [bc, br]]));
        for away in 0..=last_row {
            if self.work.is_too_much() {
                break;
            }
            let (north, south) = (middle - away, middle + away);
            let reach = |row: i64| {
                best.is_none_or(|best| (row as f64 - best.center[1]).abs() <= best.radius + 1.0)
            };
            let (go_north, go_south) =
                (north >= 0 && reach(north), away > 0 && south <= last_row && reach(south));
            // The circle is convex and meets the gate's rows: once outside on both sides, always outside.
            if away > (ar - br).abs() && !go_north && !go_south {
                break;
            }
            for (row, go) in [(north, go_north), (south, go_south)] {
                if go {
                    self.search_row(row, [[ac, ar], [bc, br]], allowed, &mut best);
                }
            }
        }
        best.map(|best| best.vertex).filter(|&vertex| vertex != NO_VERTEX)
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
        if let Some(best) = best {
            let off = row as f64 - best.center[1];
            let half = (best.radius * best.radius - off * off).max(0.0).sqrt() + 1.0;
            low = low.max((best.center[0] - half).floor() as i64);
            high = high.min((best.center[0] + half).ceil() as i64);
        }
        if low > high {
            return;
        }
        let range =
            self.row_starts[row as usize] as usize..self.row_starts[row as usize + 1] as usize;
        let first = range.start + self.at[range.clone()].partition_point(|node| node[0] < low);
        let mut steps = 1;
        for vertex in first..range.end {
            let [c, r] = self.at[vertex];
            if c > high {
                break;
            }
            steps += 1;
            let cross = dx * (ar - r) - dy * (c - ac);
            if cross <= 0 {
                continue;
            }
            let dot = (ac - c) * (bc - c) + (ar - r) * (br - r);
            let better =
                best.is_none_or(|best| match (dot * best.cross).cmp(&(best.dot * cross)) {
                    std::cmp::Ordering::Less => true,
                    std::cmp::Ordering::Equal => (vertex as u32) < best.vertex,
                    std::cmp::Ordering::Greater => false,
                });
            if better && allowed(vertex as u32) {
                *best = Some(circle(vertex as u32, dot, cross, [[ac, ar], [bc, br]]));
            }
        }
        self.work.add(steps);
    }
}

/// The circle through a, b and the vertex: its centre is cot / 2 gate lengths to the left of the gate's middle.
fn circle(vertex: u32, dot: i64, cross: i64, [[ac, ar], [bc, br]]: [[i64; 2]; 2]) -> Best {
    let cot = dot as f64 / cross as f64;
    let (dx, dy) = ((bc - ac) as f64, (ar - br) as f64);
    // Left of (dx, dy) is (−dy, dx); rows grow downwards.
    let center = [(ac + bc) as f64 / 2.0 - cot / 2.0 * dy, (ar + br) as f64 / 2.0 - cot / 2.0 * dx];
    let radius = (dx * dx + dy * dy).sqrt() / 2.0 * (1.0 + cot * cot).sqrt();
    Best { vertex, dot, cross, center, radius: radius * (1.0 + 1e-9) }
}

#[cfg(test)]
#[path = "corner_guess_tests.rs"]
mod tests;
