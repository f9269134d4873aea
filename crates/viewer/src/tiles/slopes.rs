//! The ground of a tile in squares: the mean slope of each square, and how far the ground deviates
//! from it.

use std::ops::RangeInclusive;

use corniche_geom::{Bounds, GridFrame};
use corniche_tin::Surface;

/// Squares along each side of a tile.
const SIDE: usize = 128;

/// A plane over the working CRS; heights are true heights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Plane {
    /// A point of the plane.
    pub(crate) at_m: [f64; 2],
    /// Height of the plane at that point.
    pub(crate) height_m: f64,
    /// Rise of the plane in metres per metre east and per metre north.
    pub(crate) gradient: [f64; 2],
}

impl Plane {
    fn height_at_m(&self, [x, y]: [f64; 2]) -> f64 {
        self.height_m
            + self.gradient[0] * (x - self.at_m[0])
            + self.gradient[1] * (y - self.at_m[1])
    }
}

/// The ground of a tile in squares of two cells: the mean slope of each square, and how far its
/// ground deviates from that slope.
///
/// These data give bounds on how far the ground around a road deviates from a plane, for roads as
/// wide as many triangles. The bounds are no tighter than squares of two cells allow.
pub(crate) struct Slopes {
    tile: Bounds,
    side_m: [f64; 2],
    /// The squares, row by row from the south; `None` without ground.
    squares: Vec<Option<Square>>,
}

#[derive(Debug, Clone, Copy)]
struct Square {
    /// Slope of a plane that has height 0 in the middle of the square.
    gradient: [f64; 2],
    /// The lowest and the highest ground, relative to that plane.
    range_m: [f64; 2],
}

/// A triangle of the ground in the working CRS.
struct Triangle {
    corners_m: [[f64; 3]; 3],
    gradient: [f64; 2],
}

impl Slopes {
    pub(crate) fn of_surface(surface: &Surface, tile: Bounds, frame: &GridFrame) -> Self {
        let side_m = [tile.width() / SIDE as f64, tile.height() / SIDE as f64];
        let mut slopes = Self { tile, side_m, squares: vec![None; SIDE * SIDE] };
        let triangles: Vec<Triangle> = (0_u32..)
            .zip(surface.triangles())
            .map(|(triangle, corners)| Triangle {
                corners_m: corners.map(|vertex| {
                    let [x, y] = frame.position_m(surface.points()[vertex as usize]);
                    [x, y, surface.heights_m()[vertex as usize]]
                }),
                gradient: surface
                    .gradient_m(triangle)
                    .map(|rise_m| rise_m / frame.lattice_step_m()),
            })
            .collect();
        // First the mean slope of each square, then how far its ground deviates from the slope.
        let mut sums = vec![([0.0; 2], 0.0); SIDE * SIDE];
        for triangle in &triangles {
            slopes.visit(triangle, |square, [low, high]| {
                let area = (high[0] - low[0]) * (high[1] - low[1]);
                let (sum, areas) = &mut sums[square];
                *sum = [0, 1].map(|axis| sum[axis] + area * triangle.gradient[axis]);
                *areas += area;
            });
        }
        let mut squares = vec![None; SIDE * SIDE];
        for triangle in &triangles {
            slopes.visit(triangle, |square, part| {
                let (sum, areas) = sums[square];
                let gradient =
                    if areas > 0.0 { sum.map(|sum| sum / areas) } else { triangle.gradient };
                let plane = Plane { at_m: slopes.middle(square), height_m: 0.0, gradient };
                let [low_m, high_m] = triangle.above(&plane, part);
                let range_m = &mut squares[square]
                    .get_or_insert(Square { gradient, range_m: [low_m, high_m] })
                    .range_m;
                *range_m = [range_m[0].min(low_m), range_m[1].max(high_m)];
            });
        }
        slopes.squares = squares;
        slopes
    }

    /// Maximum distance of the ground below and above a plane within a rectangle that may be
    /// rotated; its corners are given in order around it. Both are 0 without ground there.
    pub(crate) fn leaving(&self, plane: &Plane, corners_m: [[f64; 2]; 4]) -> [f64; 2] {
        let Bounds { min_x, min_y, max_x, max_y } = Bounds::around(&corners_m);
        let [columns, rows] = self.ranges([min_x, min_y], [max_x, max_y]);
        let half_m = self.side_m.map(|side_m| side_m / 2.0);
        let mut leaving_m = [0.0_f64; 2];
        for row in rows {
            for column in columns.clone() {
                let Some(square) = self.squares[row * SIDE + column] else { continue };
                let middle = self.middle(row * SIDE + column);
                if !may_meet(middle, half_m, corners_m) {
                    continue;
                }
                // The difference of two planes is greatest at a corner.
                let tilt_m = (square.gradient[0] - plane.gradient[0]).abs() * half_m[0]
                    + (square.gradient[1] - plane.gradient[1]).abs() * half_m[1];
                let above_m = plane.height_at_m(middle);
                leaving_m[0] = leaving_m[0].max(above_m - square.range_m[0] + tilt_m);
                leaving_m[1] = leaving_m[1].max(square.range_m[1] - above_m + tilt_m);
            }
        }
        leaving_m
    }

    /// Visits each square that the bounding box of a triangle intersects, with the south-west and
    /// the north-east corner of their intersection.
    fn visit(&self, triangle: &Triangle, mut visit: impl FnMut(usize, [[f64; 2]; 2])) {
        let [a, b, c] = triangle.corners_m;
        let low = [0, 1].map(|axis| a[axis].min(b[axis]).min(c[axis]));
        let high = [0, 1].map(|axis| a[axis].max(b[axis]).max(c[axis]));
        let [columns, rows] = self.ranges(low, high);
        for row in rows {
            for column in columns.clone() {
                let square = row * SIDE + column;
                let middle = self.middle(square);
                let part = [
                    [0, 1].map(|k: usize| low[k].max(middle[k] - self.side_m[k] / 2.0)),
                    [0, 1].map(|k: usize| high[k].min(middle[k] + self.side_m[k] / 2.0)),
                ];
                visit(square, part);
            }
        }
    }

    /// Columns and rows of the squares between two corners.
    fn ranges(&self, low: [f64; 2], high: [f64; 2]) -> [RangeInclusive<usize>; 2] {
        let origin = [self.tile.min_x, self.tile.min_y];
        [0, 1].map(|axis| {
            let index = |at_m: f64| {
                // The cast turns negative values into 0.
                (((at_m - origin[axis]) / self.side_m[axis]) as usize).min(SIDE - 1)
            };
            index(low[axis])..=index(high[axis])
        })
    }

    fn middle(&self, square: usize) -> [f64; 2] {
        let place = [square % SIDE, square / SIDE];
        let origin = [self.tile.min_x, self.tile.min_y];
        [0, 1].map(|axis| origin[axis] + (place[axis] as f64 + 0.5) * self.side_m[axis])
    }
}

impl Triangle {
    /// The lowest and the highest height above a plane that the triangle may have in a box. The
    /// bounds come from the triangle's own plane in that box, and from the heights of its corners.
    fn above(&self, plane: &Plane, [low, high]: [[f64; 2]; 2]) -> [f64; 2] {
        let above_m = |[x, y, height_m]: [f64; 3]| height_m - plane.height_at_m([x, y]);
        let [a, b, c] = self.corners_m.map(above_m);
        let bend = [0, 1].map(|axis| self.gradient[axis] - plane.gradient[axis]);
        let [x, y] = [0, 1].map(|axis: usize| f64::midpoint(low[axis], high[axis]));
        let middle_m =
            a + bend[0] * (x - self.corners_m[0][0]) + bend[1] * (y - self.corners_m[0][1]);
        let reach_m = 0.5
            * (bend[0].abs() * (high[0] - low[0]).max(0.0)
                + bend[1].abs() * (high[1] - low[1]).max(0.0));
        let (least_m, most_m) = (a.min(b).min(c), a.max(b).max(c));
        [(middle_m - reach_m).clamp(least_m, most_m), (middle_m + reach_m).clamp(least_m, most_m)]
    }
}

/// Whether a square and a rectangle that may be rotated may intersect. The result is false only if
/// a side of the rectangle separates them, so it is true for some that do not intersect.
fn may_meet(middle: [f64; 2], half_m: [f64; 2], corners_m: [[f64; 2]; 4]) -> bool {
    (0..4).all(|k| {
        let ([x, y], [to_x, to_y]) = (corners_m[k], corners_m[(k + 1) % 4]);
        // The inside is to the left of each side.
        let (left, forward) = (y - to_y, to_x - x);
        let inside = (middle[0] - x) * left + (middle[1] - y) * forward;
        inside + left.abs() * half_m[0] + forward.abs() * half_m[1] >= 0.0
    })
}

#[cfg(test)]
#[path = "slopes_tests.rs"]
mod tests;
