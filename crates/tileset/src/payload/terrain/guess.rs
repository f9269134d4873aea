//! What writer and reader both expect of heights and normals; a section holds the differences.

use corniche_tin::TinVertex;

use crate::payload::connectivity::Reached;
use crate::payload::terrain::record::Scale;

/// The height to expect at a vertex, from those that the walk met before.
///
/// Halfway between the middle of the gate and the parallelogram over the triangle below it, which alone overshoots
/// on rough ground. (Weighting all neighbours by distance saves 3 to 5 % more of the heights, at the price of
/// arithmetic that is hard to specify to the bit.)
pub(crate) fn guess_height(reached: &Reached, heights: &[i32], previous: i32) -> i32 {
    let Reached { vertex, gate } = *reached;
    if gate == [vertex; 3] {
        return previous;
    }
    let [a, b, d] = gate.map(|vertex| i64::from(heights[vertex as usize]));
    // (3a + 3b − 2d) / 4, rounded down.
    (3 * (a + b) - 2 * d).div_euclid(4).clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32
}

/// The normals to expect: of the triangles around each vertex, weighted by their areas, octahedron-coded.
///
/// An upward normal (x, y, z) is (x, y) / (|x| + |y| + z) on the octahedron: no root, so every machine
/// computes the same bits.
pub(crate) fn guess_normals(
    vertices: &[TinVertex],
    triangles: &[[u32; 3]],
    scale: Scale,
) -> Vec<[i8; 2]> {
    let mut sums = vec![[0_i64; 3]; vertices.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|vertex| {
            let TinVertex { row, column, height_q } = vertices[vertex as usize];
            [i64::from(column), -i64::from(row), i64::from(height_q)]
        });
        let edge = |p: [i64; 3]| [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
        let (p, q) = (edge(b), edge(c));
        let normal =
            [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
        for &vertex in triangle {
            for (sum, part) in sums[vertex as usize].iter_mut().zip(normal) {
                *sum += part;
            }
        }
    }
    let steepness = scale.cell.to_array().map(|side_m| scale.quantum_m / side_m);
    sums.iter()
        .map(|&[x, y, z]| {
            let (x, y, z) = (x as f64 * steepness[0], y as f64 * steepness[1], z as f64);
            let length = x.abs() + y.abs() + z;
            // `as` turns the not-a-number of a vertex without triangles into 0.
            [x, y].map(|value| (value / length * 127.0).round() as i8)
        })
        .collect()
}
