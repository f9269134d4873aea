//! The length of the part of the road network to which a road belongs, so that short parts without
//! connections can be hidden.

use std::{borrow::Cow, collections::BTreeMap};

use corniche_geom::{Bounds, DisjointSets, along};

use super::{
    super::{distance, shares_in},
    NearHeights, RoadKind, RoadLook,
    flat_ends::is_inside,
};

/// The length of a part that is not completely known, working metres; larger than any other.
pub(crate) const OPEN_M: f32 = 1e15;

/// Maximum number of squares that the lines of a tile may pass through in total: ten times as many
/// as in the fullest tile of a large city. If there are more, all parts count as open.
const MOST_SQUARES: usize = 1 << 22;

/// A line of the road network.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NetLine {
    pub(crate) kind: RoadKind,
    /// Its vertices in plan.
    pub(crate) vertices_m: Vec<[f64; 2]>,
}

/// The drawn part of a line on the ground, and the length of the part of the network to which the
/// line belongs, working metres.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct InNet<'a, L: Clone> {
    pub(crate) line: Cow<'a, L>,
    pub(crate) part_m: f32,
}

/// The known part of the network: the rectangle of the tile, the extent of its lines, and the
/// distance within which lines are connected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct KnownNet {
    pub(crate) tile: Bounds,
    /// How far beyond the tile lines are known.
    pub(crate) margin_m: f64,
    /// Lines this close to each other are connected. On coarse levels each line is simplified by
    /// itself, so that roads that meet need not have a common point; simplification moves a line by
    /// less than a cell.
    pub(crate) near_m: f64,
}

/// For each line, the length of the part of the network to which it belongs among lines of its
/// class and more important ones, working metres. [`OPEN_M`] if that part may continue where this
/// tile knows no lines.
///
/// ```text
///    ┌──────────────────────┐    a is drawn long before b. While b is not shown, a stands alone, and its part of the
///    │    ━━━a━━━┄┄┄┄b┄┄┄┄┄┄│┄   network is as long as a. The part of b is a and b; it leaves the tile, so it is open.
///    │                      │
///    └──────────────────────┘
/// ```
///
/// A part is open if it meets the tile's border, in both methods. So all tiles that contain a part
/// decide alike, but a short part across a border counts as open.
pub(crate) fn part_lengths_m(lines: &[NetLine], known: KnownNet) -> Vec<f32> {
    let mut order: Vec<usize> = (0..lines.len()).collect();
    order.sort_by_key(|number| (rank(&lines[*number]), *number));
    let mut net = Net {
        parts: DisjointSets::new(0),
        lengths_m: Vec::new(),
        at: BTreeMap::new(),
        known,
        left: MOST_SQUARES,
    };
    let mut lengths_m = vec![OPEN_M; lines.len()];
    for run in order.chunk_by(|a, b| rank(&lines[*a]) == rank(&lines[*b])) {
        let parts: Vec<usize> = run.iter().map(|&n| net.add(&lines[n])).collect();
        if net.left == 0 {
            return vec![OPEN_M; lines.len()];
        }
        for (&number, part) in run.iter().zip(parts) {
            lengths_m[number] = net.lengths_m[net.parts.first_of(part)] as f32;
        }
    }
    lengths_m
}

/// The rank of a line: lines of a lower rank are shown from farther away.
fn rank(line: &NetLine) -> (u8, bool) {
    (line.kind.class.number(), line.kind.look == RoadLook::Service)
}

impl KnownNet {
    /// The known network of the lines inside a tile, without its neighbours.
    pub(crate) fn within(tile: Bounds) -> Self {
        let near_m = NearHeights::reach_m([tile.width(), tile.height()]);
        Self { tile, margin_m: 0.0, near_m }
    }

    /// Whether a line and its neighbourhood are completely known: it is inside the tile, or between
    /// the tile and the end of its margin.
    fn holds(&self, vertices_m: &[[f64; 2]]) -> bool {
        let Self { tile, margin_m, near_m } = *self;
        let inside = |grown_m: f64| {
            let grown = tile.expanded([grown_m; 2]);
            move |at: &[f64; 2]| is_inside(grown, *at)
        };
        let beyond_one_side = vertices_m.iter().all(|at| at[0] < tile.min_x)
            || vertices_m.iter().all(|at| at[0] > tile.max_x)
            || vertices_m.iter().all(|at| at[1] < tile.min_y)
            || vertices_m.iter().all(|at| at[1] > tile.max_y);
        vertices_m.iter().all(inside(0.0))
            || beyond_one_side && vertices_m.iter().all(inside(margin_m - near_m))
    }

    /// Visits the squares of points along a line, at most the width of a square apart, until
    /// `visit` returns false. Where two lines cross, they have points in the same square or in
    /// adjacent squares.
    ///
    /// Only squares near the tile are visited, wherever a line goes: lines that meet beyond them
    /// are open anyway, because not everything is known there.
    fn squares(&self, vertices_m: &[[f64; 2]], mut visit: impl FnMut([i64; 2]) -> bool) {
        let Self { tile, margin_m, near_m } = *self;
        // A completely known line ends one square before the margin; connected lines have points up
        // to two squares farther.
        let grown_m = margin_m.max(0.0) + 3.0 * near_m;
        let Bounds { min_x, min_y, max_x, max_y } = tile.expanded([grown_m; 2]);
        let around = [[min_x, max_x], [min_y, max_y]];
        let mut last = None;
        let mut goes_on = |[x, y]: [f64; 2]| {
            let square = [x, y].map(|value| (value / near_m).floor() as i64);
            last.replace(square) == Some(square) || visit(square)
        };
        for pair in vertices_m.windows(2) {
            let way = [0, 1].map(|k| pair[1][k] - pair[0][k]);
            let steps = (distance(pair[0], pair[1]) / near_m).ceil().max(1.0);
            let [first, end] = shares_in(pair[0], way, around, 1.0);
            if first > end {
                continue;
            }
            let numbers =
                (first * steps - 1.0).max(0.0) as u64..(end * steps + 2.0).min(steps) as u64;
            for step in numbers {
                let share = step as f64 / steps;
                if !goes_on(along(pair[0], pair[1], share)) {
                    return;
                }
            }
        }
        vertices_m.last().map(|last| goes_on(*last));
    }
}

/// Parts of the network.
struct Net {
    /// Which lines are connected.
    parts: DisjointSets,
    /// The total length of the lines of a part; stored at the first of them.
    lengths_m: Vec<f64>,
    /// For each square, a line that passes through it.
    at: BTreeMap<[i64; 2], usize>,
    known: KnownNet,
    /// Remaining number of squares that may be visited.
    left: usize,
}

impl Net {
    /// Adds a line and returns its number.
    fn add(&mut self, line: &NetLine) -> usize {
        let vertices_m = &line.vertices_m;
        let length_m = vertices_m.windows(2).map(|pair| distance(pair[0], pair[1])).sum();
        let length_m = if self.known.holds(vertices_m) { length_m } else { f64::from(OPEN_M) };
        let number = self.parts.add();
        self.lengths_m.push(length_m);
        let known = self.known;
        known.squares(vertices_m, |square| {
            self.left = self.left.saturating_sub(1);
            // In a square that this line visited before, its neighbours were connected already.
            if self.at.get(&square) != Some(&number) {
                let around = [-1, 0, 1].into_iter().flat_map(|dx| [-1, 0, 1].map(|dy| [dx, dy]));
                for [dx, dy] in around {
                    if let Some(&other) = self.at.get(&[square[0] + dx, square[1] + dy]) {
                        self.join(number, other);
                    }
                }
                self.at.insert(square, number);
            }
            self.left > 0
        });
        number
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.parts.first_of(a), self.parts.first_of(b));
        if a != b {
            self.parts.join(a, b);
            let sum_m = self.lengths_m[a] + self.lengths_m[b];
            self.lengths_m[a.min(b)] = sum_m.min(f64::from(OPEN_M));
        }
    }
}

#[cfg(test)]
#[path = "parts_tests.rs"]
mod tests;
