//! Codes normals, each as its difference from the normal of the triangles around its vertex.

use corniche_tin::TinVertex;

use crate::payload::{
    connectivity::Reached,
    magnitudes::{Magnitudes, half_octave},
    range_coder::Bits,
    terrain::record::Scale,
};

/// Numbers of contexts: half-octaves of the differences at the gate; the difference of the guesses
/// from those at the gate, combined with the difference east of the same vertex.
const BY_RESIDUALS: usize = 24;
const BY_GUESSES: usize = 48;

/// Codes the normals of all vertices, in units of 2^`shift`, in the order of the walk. A writer
/// passes the normals, a reader zeros. `guesses` are those of [`guess_normals`] with the same
/// shift.
pub(crate) fn code_normals<B: Bits>(
    bits: &mut B,
    order: &[Reached],
    guesses: &[[i8; 2]],
    shift: u8,
    normals: &mut [[i8; 2]],
) {
    let mut numbers = [(); 2].map(|()| Magnitudes::<BY_RESIDUALS, BY_GUESSES>::default());
    let mut sizes = vec![0_u16; normals.len()];
    for reached in order {
        let vertex = reached.vertex as usize;
        let guess = guesses[vertex];
        let gate = reached.gate.map(|corner| corner as usize);
        let around: u64 = gate.iter().map(|&corner| u64::from(sizes[corner])).sum();
        let apart = gate.map(|corner| {
            (0..2).map(|axis| u64::from(guesses[corner][axis].abs_diff(guess[axis]))).sum::<u64>()
        });
        let bend = (half_octave(apart.iter().sum::<u64>()) / 2).min(7);
        let mut size = 0;
        let mut first = 0;
        for axis in 0..2 {
            let wanted = i64::from(normals[vertex][axis] >> shift) - i64::from(guess[axis]);
            let residual =
                numbers[axis].code(bits, [half_octave(around), bend + 8 * first], wanted);
            // A writer's normals fit; a sum out of range, which only occurs in damaged bytes,
            // wraps.
            normals[vertex][axis] = ((i64::from(guess[axis]) + residual) << shift) as i8;
            size += residual.unsigned_abs().min(255) as u16;
            first = half_octave(residual.unsigned_abs()).div_ceil(2).min(5);
        }
        sizes[vertex] = size;
    }
}

/// Predicts the normals from the triangles around each vertex, weighted by their areas,
/// octahedron-coded, in units of 2^`shift`.
///
/// An upward normal (x, y, z) is (x, y) / (|x| + |y| + z) on the octahedron, which needs no square
/// root, so every machine computes the same bits.
pub(crate) fn guess_normals(
    vertices: &[TinVertex],
    triangles: &[[u32; 3]],
    scale: Scale,
    shift: u8,
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
    let steps = 127.0 / f64::from(1_u32 << shift);
    sums.iter()
        .map(|&[x, y, z]| {
            let (x, y, z) = (x as f64 * steepness[0], y as f64 * steepness[1], z as f64);
            let length = x.abs() + y.abs() + z;
            // `as` converts the NaN of a vertex without triangles to 0.
            [x, y].map(|value| (value / length * steps).round() as i8)
        })
        .collect()
}
