//! Geometry of TINs for checks. It shares no code with the build: it uses f64 in cells of the tile
//! and a grid of buckets, without adjacency.

use std::{mem::size_of_val, ops::RangeInclusive};

use corniche_geom::{IndexLists, StepBudget};
use corniche_tin::Tin;

/// Buckets along one side of a tile.
const BUCKETS: usize = 64;
const TILE_CELLS: f64 = 256.0;
/// Tolerance for comparing heights that were computed in two ways, metres.
pub(crate) const HEIGHT_ROUNDING_M: f64 = 1e-6;
/// The distance outside a triangle, in cells, at which a point still counts as inside: the rounding
/// error of f64 at the scale of a tile, far below a millimetre.
const SLACK_CELLS: f64 = 1e-7;

/// The least length, in lattice steps, that a line must run inside a triangle to meet it: lines are
/// rounded to the lattice where they are cut.
const MET_STEPS: f64 = 8.0;
/// The distance from the edges at which a line must run inside a triangle to meet it, for the same
/// reason.
const INSIDE_STEPS: f64 = 2.0;

/// A tile's triangles, prepared for the lookup of heights. Positions are (column, row) in the
/// tile's own cells.
pub(crate) struct TriangleSoup {
    /// Corners of each triangle: column, row, height in metres.
    triangles: Vec<Corners>,
    /// Triangles by bucket.
    buckets: IndexLists,
    /// The first and the last row and column of each triangle's buckets.
    boxes: Vec<BucketBox>,
    /// The lowest and the highest corner of the triangles in each bucket.
    heights_m: Vec<[f64; 2]>,
    /// Lattice steps per cell, east and north.
    steps: [f64; 2],
}

type Corners = [[f64; 3]; 3];

#[derive(Clone, Copy)]
struct BucketBox {
    rows: [u8; 2],
    columns: [u8; 2],
}

/// A segment, with the distance around it to search along each axis, in cells.
#[derive(Clone, Copy)]
struct Strip {
    ends: [[f64; 2]; 2],
    reach: [f64; 2],
}

impl TriangleSoup {
    /// `steps` are the lattice steps per cell, which queries about lengths need.
    pub(crate) fn new(tin: &Tin, quantum_m: f64, steps: [f64; 2]) -> Self {
        let triangles: Vec<Corners> = tin
            .triangles()
            .iter()
            .map(|corners| {
                corners.map(|corner| {
                    let vertex = &tin.vertices()[corner as usize];
                    let height_m = f64::from(vertex.height_q) * quantum_m;
                    [f64::from(vertex.column), f64::from(vertex.row), height_m]
                })
            })
            .collect();
        let extent = |triangle: usize, axis: usize| {
            let values = triangles[triangle].map(|corner| corner[axis]);
            let low = values.into_iter().fold(f64::INFINITY, f64::min);
            [low, values.into_iter().fold(f64::NEG_INFINITY, f64::max)]
        };
        let boxes: Vec<BucketBox> = (0..triangles.len())
            .map(|triangle| {
                let [columns, rows] = [0, 1].map(|axis| buckets_of(extent(triangle, axis)));
                BucketBox { rows, columns }
            })
            .collect();
        let buckets = IndexLists::new(BUCKETS * BUCKETS, triangles.len(), |triangle| {
            let BucketBox { rows, columns } = boxes[triangle];
            let [first, last] = columns.map(usize::from);
            let rows = usize::from(rows[0])..=usize::from(rows[1]);
            rows.flat_map(move |row| (first..=last).map(move |column| row * BUCKETS + column))
        });
        let heights_m = (0..BUCKETS * BUCKETS).map(|bucket| {
            let none = [f64::INFINITY, f64::NEG_INFINITY];
            buckets.list(bucket).iter().fold(none, |[low, high], &triangle| {
                let [low_m, high_m] = extent(triangle as usize, 2);
                [low.min(low_m), high.max(high_m)]
            })
        });
        let heights_m = heights_m.collect();
        Self { triangles, buckets, boxes, heights_m, steps }
    }

    /// The size in memory.
    pub(crate) fn bytes(&self) -> usize {
        let [starts, indices] = self.buckets.parts();
        size_of_val(starts)
            + size_of_val(indices)
            + size_of_val(&*self.triangles)
            + size_of_val(&*self.boxes)
            + size_of_val(&*self.heights_m)
    }

    /// All triangles that contain the point, borders included.
    fn holding(&self, at: [f64; 2]) -> impl Iterator<Item = &Corners> + '_ {
        self.buckets
            .list(bucket(at[1]) * BUCKETS + bucket(at[0]))
            .iter()
            .map(|&triangle| &self.triangles[triangle as usize])
            .filter(move |corners| holds(corners, at))
    }

    /// The height of the ground, in metres; `None` without ground. Where triangles meet, the first
    /// one counts.
    pub(crate) fn height_m(&self, at: [f64; 2]) -> Option<f64> {
        self.holding(at).next().map(|corners| height(corners, at))
    }

    /// The gap between the edge from `a` to `b` (column, row, height) and the closest single
    /// triangle: the smallest, over all triangles that contain both ends, of the larger gap at the
    /// two ends. `None` if no triangle contains both.
    ///
    /// A triangle is convex and flat, so the gap along the edge is never larger than at its ends.
    pub(crate) fn edge_gap_m(&self, a: [f64; 3], b: [f64; 3]) -> Option<f64> {
        let middle = [f64::midpoint(a[0], b[0]), f64::midpoint(a[1], b[1])];
        self.holding(middle)
            .filter(|corners| holds(corners, flat(a)) && holds(corners, flat(b)))
            .map(|corners| {
                let gap = |p: [f64; 3]| (height(corners, flat(p)) - p[2]).abs();
                gap(a).max(gap(b))
            })
            .reduce(f64::min)
    }

    /// The buckets of a strip, each with the triangles that no earlier bucket had.
    ///
    /// A strip is convex, so the rows in which a triangle's columns meet those of the strip are
    /// consecutive. A triangle is returned in the first of these rows, in the first bucket there.
    fn near(
        &self,
        strip: Strip,
    ) -> impl Iterator<Item = (usize, impl Iterator<Item = &Corners> + '_)> + '_ {
        let rows = strip.rows();
        let first_row = *rows.start();
        rows.flat_map(move |row| {
            let above = if row > first_row { strip.columns(row - 1) } else { None };
            let own = strip.columns(row);
            own.into_iter().flat_map(move |[begin, end]| {
                (begin..=end).map(move |column| {
                    let is_first = move |triangle: &usize| {
                        let own = &self.boxes[*triangle];
                        let [first, last] = own.columns.map(usize::from);
                        let was_above = usize::from(own.rows[0]) < row
                            && above.is_some_and(|[begin, end]| begin <= last && first <= end);
                        !was_above && column == first.max(begin)
                    };
                    let bucket = row * BUCKETS + column;
                    let triangles =
                        self.buckets.list(bucket).iter().map(|&triangle| triangle as usize);
                    let given =
                        triangles.filter(is_first).map(|triangle| &self.triangles[triangle]);
                    (bucket, given)
                })
            })
        })
    }

    /// The lowest and the highest ground in the rectangle that reaches `margin` lattice steps
    /// beyond a segment on every side. `None` without ground there. Reading a bucket or a triangle
    /// is a step of `work`.
    pub(crate) fn range_near(
        &self,
        [a, b]: [[f64; 2]; 2],
        margin: f64,
        work: &StepBudget,
    ) -> Option<[f64; 2]> {
        let (p, q) = (self.in_steps(a), self.in_steps(b));
        let length = (q[0] - p[0]).hypot(q[1] - p[1]);
        let way = if length > 0.0 {
            [(q[0] - p[0]) / length, (q[1] - p[1]) / length]
        } else {
            [1.0, 0.0]
        };
        // The rectangle's corners are at most this far from the ends along an axis.
        let reach = [0, 1].map(|axis| margin * (way[0].abs() + way[1].abs()) / self.steps[axis]);
        let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut widen = |corners: &Corners| {
            let turned = corners.map(|[column, row, height]| {
                let at = self.in_steps([column, row]);
                let (du, dv) = (at[0] - p[0], at[1] - p[1]);
                [du * way[0] + dv * way[1], dv * way[0] - du * way[1], height]
            });
            let is_inside = |[along, across, _]: &[f64; 3]| {
                (-margin..=length + margin).contains(along) && across.abs() <= margin
            };
            // Most triangles of a bucket are outside the rectangle, on one side of it.
            let is_beside = turned.iter().all(|[along, ..]| *along < -margin)
                || turned.iter().all(|[along, ..]| *along > length + margin)
                || turned.iter().all(|[_, across, _]| *across < -margin)
                || turned.iter().all(|[_, across, _]| *across > margin);
            let part = if is_beside {
                Vec::new()
            } else if turned.iter().all(is_inside) {
                turned.to_vec()
            } else {
                let part = cut(&turned, |[along, ..]| along + margin);
                let part = cut(&part, |[along, ..]| length + margin - along);
                let part = cut(&part, |[_, across, _]| across + margin);
                cut(&part, |[_, across, _]| margin - across)
            };
            for [.., height] in part {
                lowest = lowest.min(height);
                highest = highest.max(height);
            }
            [lowest, highest]
        };
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        // Heights within the range cannot widen it.
        let is_within =
            |[low, high]: [f64; 2], range: [f64; 2]| range[0] <= low && high <= range[1];
        for (bucket, triangles) in self.near(Strip { ends: [a, b], reach }) {
            work.add(1);
            if is_within(self.heights_m[bucket], range) {
                continue;
            }
            for corners in triangles {
                work.add(1);
                let [a, b, c] = corners.map(|corner| corner[2]);
                if !is_within([a.min(b).min(c), a.max(b).max(c)], range) {
                    range = widen(corners);
                }
            }
        }
        (range[0] <= range[1]).then_some(range)
    }

    /// A position in lattice steps, with north up.
    fn in_steps(&self, [column, row]: [f64; 2]) -> [f64; 2] {
        [column * self.steps[0], -row * self.steps[1]]
    }

    /// Whether the segment runs inside a triangle for more than a few lattice steps. Reading a
    /// triangle is a step of `work`.
    pub(crate) fn meets(&self, [a, b]: [[f64; 2]; 2], work: &StepBudget) -> bool {
        let (p, q) = (self.in_steps(a), self.in_steps(b));
        let length = (q[0] - p[0]).hypot(q[1] - p[1]);
        let strip = Strip { ends: [a, b], reach: [0.0; 2] };
        self.near(strip).flat_map(|(_, triangles)| triangles).any(|corners| {
            work.add(1);
            let at = corners.map(|corner| self.in_steps(flat(corner)));
            let (mut from, mut to) = (0.0_f64, 1.0_f64);
            for k in 0..3 {
                let (c, d) = (at[k], at[(k + 1) % 3]);
                // North is up, so the inside is on the left.
                let inside =
                    |point| area(c, d, point) / (d[0] - c[0]).hypot(d[1] - c[1]) - INSIDE_STEPS;
                let (here, there) = (inside(p), inside(q));
                if here < 0.0 && there < 0.0 {
                    return false;
                }
                if here < 0.0 {
                    from = from.max(here / (here - there));
                } else if there < 0.0 {
                    to = to.min(here / (here - there));
                }
            }
            (to - from) * length > MET_STEPS
        })
    }

    /// The heights at a square of nodes, row by row: the first node is at (column, row) `first`,
    /// neighbours are `step` cells apart. NaN without ground.
    pub(crate) fn raster(&self, first: [f64; 2], step: f64, side: usize) -> Vec<f64> {
        let mut heights = vec![f64::NAN; side * side];
        let last = (side - 1) as f64;
        let half = last * step / 2.0;
        let middle = first.map(|cells| cells + half);
        let square = Strip { ends: [middle; 2], reach: [half.abs(); 2] };
        for corners in self.near(square).flat_map(|(_, triangles)| triangles) {
            let at = corners.map(|c| [(c[0] - first[0]) / step, (c[1] - first[1]) / step, c[2]]);
            let [a, b, c] = at;
            let whole = area(flat(a), flat(b), flat(c));
            let rise = |axis: usize| {
                let to = |p: [f64; 3]| p[1 - axis] - a[1 - axis];
                let sign = if axis == 0 { 1.0 } else { -1.0 };
                sign * ((b[2] - a[2]) * to(c) - (c[2] - a[2]) * to(b)) / whole
            };
            let [east_m, south_m] = [rise(0), rise(1)];
            let rows = at.map(|corner| corner[1]);
            let low = rows.into_iter().fold(f64::INFINITY, f64::min).max(0.0).ceil();
            let high = rows.into_iter().fold(f64::NEG_INFINITY, f64::max).min(last).floor();
            let length = [0, 1, 2].map(|k| {
                let (a, b) = (flat(at[k]), flat(at[(k + 1) % 3]));
                (b[0] - a[0]).hypot(b[1] - a[1])
            });
            let mut row = low;
            while row <= high {
                let (mut west, mut east) = (0.0_f64, last);
                for k in 0..3 {
                    let (a, b) = (flat(at[k]), flat(at[(k + 1) % 3]));
                    let (rise, reach) = (b[1] - a[1], (b[0] - a[0]) * (row - a[1]));
                    let slack = SLACK_CELLS * length[k];
                    // Like in `holds`: reach − rise · (column − a) is at most the slack.
                    if rise > 0.0 {
                        west = west.max(a[0] + (reach - slack) / rise);
                    } else if rise < 0.0 {
                        east = east.min(a[0] + (reach - slack) / rise);
                    } else if reach > slack {
                        east = -1.0;
                    }
                }
                let mut column = west.ceil();
                while column <= east {
                    heights[row as usize * side + column as usize] =
                        a[2] + (column - a[0]) * east_m + (row - a[1]) * south_m;
                    column += 1.0;
                }
                row += 1.0;
            }
        }
        heights
    }
}

impl Strip {
    /// The tolerance for rounding of the segment's position.
    fn slack(&self) -> f64 {
        let size = self.ends.as_flattened().iter().fold(0.0_f64, |size, at| size.max(at.abs()));
        SLACK_CELLS + size * 1e-12
    }

    /// The rows of buckets that the strip may touch.
    fn rows(&self) -> RangeInclusive<usize> {
        let [a, b] = self.ends.map(|end| end[1]);
        let reach = self.reach[1] + self.slack();
        bucket(a.min(b) - reach)..=bucket(a.max(b) + reach)
    }

    /// The first and the last column that the strip may touch in a row of buckets. Parts outside
    /// the tile count for the buckets at its border.
    fn columns(&self, row: usize) -> Option<[usize; 2]> {
        let [a, b] = self.ends;
        let slack = self.slack();
        let border = |row: usize| row as f64 * TILE_CELLS / BUCKETS as f64;
        let low = if row == 0 { f64::NEG_INFINITY } else { border(row) - self.reach[1] - slack };
        let is_last = row + 1 == BUCKETS;
        let high = if is_last { f64::INFINITY } else { border(row + 1) + self.reach[1] + slack };
        let fall = b[1] - a[1];
        let shares = if fall == 0.0 {
            (low <= a[1] && a[1] <= high).then_some([0.0, 1.0])?
        } else {
            let [one, other] = [low, high].map(|at| (at - a[1]) / fall);
            [one.min(other).max(0.0), one.max(other).min(1.0)]
        };
        if shares[0] > shares[1] {
            return None;
        }
        let [from, to] = shares.map(|share| a[0] + share * (b[0] - a[0]));
        let reach = self.reach[0] + slack;
        Some([bucket(from.min(to) - reach), bucket(from.max(to) + reach)])
    }
}

/// The part of a convex polygon where `inside`, an affine function, is at least 0.
fn cut(corners: &[[f64; 3]], inside: impl Fn([f64; 3]) -> f64) -> Vec<[f64; 3]> {
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for (k, &this) in corners.iter().enumerate() {
        let next = corners[(k + 1) % corners.len()];
        let (here, there) = (inside(this), inside(next));
        if here >= 0.0 {
            kept.push(this);
        }
        if (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0) {
            let part = here / (here - there);
            kept.push([0, 1, 2].map(|axis| this[axis] + part * (next[axis] - this[axis])));
        }
    }
    kept
}

/// The first and the last row or column of the buckets that a range contains, in cells.
fn buckets_of([low, high]: [f64; 2]) -> [u8; 2] {
    [bucket(low - SLACK_CELLS), bucket(high + SLACK_CELLS)].map(|bucket| bucket as u8)
}

fn bucket(cells: f64) -> usize {
    ((cells / TILE_CELLS * BUCKETS as f64).max(0.0) as usize).min(BUCKETS - 1)
}

/// Twice the signed area; rows grow southwards, so the TIN's counter-clockwise triangles are
/// negative here.
fn area(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn flat([column, row, _]: [f64; 3]) -> [f64; 2] {
    [column, row]
}

fn holds(corners: &Corners, at: [f64; 2]) -> bool {
    (0..3).all(|k| {
        let (a, b) = (flat(corners[k]), flat(corners[(k + 1) % 3]));
        let area = area(a, b, at);
        // Nearly all points are on one side or the other, and do not need the length.
        area <= 0.0 || area <= SLACK_CELLS * (b[0] - a[0]).hypot(b[1] - a[1])
    })
}

fn height(corners: &Corners, at: [f64; 2]) -> f64 {
    let [a, b, c] = *corners;
    let whole = area(flat(a), flat(b), flat(c));
    let weight_b = area(flat(a), at, flat(c)) / whole;
    let weight_c = area(flat(a), flat(b), at) / whole;
    a[2] + weight_b * (b[2] - a[2]) + weight_c * (c[2] - a[2])
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these numbers are exact")]
#[path = "triangle_soup_tests.rs"]
mod tests;
