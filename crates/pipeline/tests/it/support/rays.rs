//! Casts rays at triangles in f64, by brute force except for squares in plan that a ray does not
//! pass.

use std::collections::HashMap;

/// x and y in cells, height in metres.
pub(crate) type Point = [f64; 3];

/// Side of a square, cells.
const SIDE: f64 = 32.0;
/// A ray that passes a triangle at this distance, as a fraction of its size, hits it: edges shared
/// by two triangles have no gaps.
const SLACK: f64 = 1e-9;

/// Triangles in squares of plan.
#[derive(Default)]
pub(crate) struct Scene {
    triangles: Vec<[Point; 3]>,
    squares: HashMap<[i64; 2], Vec<u32>>,
}

impl Scene {
    pub(crate) fn add(&mut self, triangle: [Point; 3]) {
        let index = self.triangles.len() as u32;
        for square in squares(&triangle) {
            self.squares.entry(square).or_default().push(index);
        }
        self.triangles.push(triangle);
    }

    /// Whether there is anything on the way from one point to another.
    pub(crate) fn hits(&self, from: Point, to: Point) -> bool {
        // The way is tested piece by piece, so that a long way across the corner of many squares
        // does not test all of them.
        let pieces = ((to[0] - from[0]).hypot(to[1] - from[1]) / SIDE).ceil().max(1.0);
        let at = |piece: f64| [0, 1, 2].map(|k| from[k] + (to[k] - from[k]) * piece / pieces);
        (0..pieces as u32).any(|piece| {
            let ends = [at(f64::from(piece)), at(f64::from(piece) + 1.0)];
            squares(&ends).any(|square| {
                let near = self.squares.get(&square).map_or(&[][..], Vec::as_slice);
                near.iter().any(|&index| is_hit(&self.triangles[index as usize], from, to))
            })
        })
    }
}

/// The squares that the bounding box of some points touches.
fn squares(points: &[Point]) -> impl Iterator<Item = [i64; 2]> + use<> {
    let range = |axis: usize| {
        let at = points.iter().map(|point| point[axis] / SIDE);
        let [low, high] = at.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| {
            [low.min(at), high.max(at)]
        });
        // A point on the border of a square is in both squares.
        (low - SLACK).floor() as i64..=(high + SLACK).floor() as i64
    };
    let (columns, rows) = (range(0), range(1));
    columns.flat_map(move |column| rows.clone().map(move |row| [column, row]))
}

/// Source: Möller & Trumbore 1997, *Fast, Minimum Storage Ray/Triangle Intersection*.
fn is_hit([a, b, c]: &[Point; 3], from: Point, to: Point) -> bool {
    let (way, ab, ac) = (minus(to, from), minus(*b, *a), minus(*c, *a));
    let across = cross(way, ac);
    let scale = dot(ab, across);
    if scale == 0.0 {
        return false;
    }
    let start = minus(from, *a);
    let u = dot(start, across) / scale;
    let up = cross(start, ab);
    let (v, t) = (dot(way, up) / scale, dot(ac, up) / scale);
    u >= -SLACK && v >= -SLACK && u + v <= 1.0 + SLACK && (0.0..=1.0).contains(&t)
}

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
