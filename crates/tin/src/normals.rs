//! Normals of the ground at the vertices of a TIN, and their encoding in two bytes.

use corniche_geom::{Cell, HeightGrid};

use crate::Tin;

/// Returns the unit normals of the ground at the vertices of `tin`, octahedron-coded; see
/// [`decode_normal`].
///
/// They are computed from the gradient of `heights`, the tile's raster with one more node on each
/// side, as for [`triangulate`](crate::triangulate): central differences, one-sided next to a gap,
/// level if both neighbours are gaps. `cell` is the spacing of the nodes. Codes are multiples of
/// 2^`shift`, see [`normal_shift`]. The rule is local, so a node has the same normal in every tile
/// of a level that contains it.
///
/// # Panics
/// When a vertex is outside the grid, because `tin` does not belong to these heights.
#[must_use]
pub fn normals(heights: &HeightGrid, tin: &Tin, cell: Cell, shift: u8) -> Vec<[i8; 2]> {
    tin.vertices()
        .iter()
        .map(|vertex| {
            let node = [usize::from(vertex.column) + 1, usize::from(vertex.row) + 1];
            let [east, north] = gradient(heights, node, cell);
            encode_normal([-east, -north, 1.0], shift)
        })
        .collect()
}

/// The precision of the normals of a level: their codes are multiples of 2^this.
///
/// A TIN determines the slope of the ground only to within its tolerance divided by the length of
/// an edge, which is a few cells. Steps of 4 / 127 have an error of up to 1/64, which is half of
/// the slope error across one cell at a tolerance of a 32nd of a cell: from there on, finer normals
/// are more precise than the TIN. For smaller tolerances the steps are 2 / 127, from a 64th of a
/// cell on, or 1 / 127. All tiles of a level have the same steps, so the normals on a border are
/// equal on both sides.
#[must_use]
pub fn normal_shift(max_error_m: f64, cell: Cell) -> u8 {
    let longest_m = cell.east_m.max(cell.north_m);
    if 32.0 * max_error_m >= longest_m { 2 } else { u8::from(64.0 * max_error_m >= longest_m) }
}

/// The rise of the ground at a node in metres per metre east and per metre north: central
/// differences, one-sided next to a gap, level if both neighbours are gaps. `cell` is the spacing
/// of the nodes.
///
/// # Panics
/// When the node is on the grid's border: it needs a neighbour on each side.
#[must_use]
pub fn gradient(heights: &HeightGrid, [column, row]: [usize; 2], cell: Cell) -> [f64; 2] {
    let height_m = |column: usize, row: usize| heights.height(column, row).map(f64::from);
    let here = height_m(column, row);
    [
        slope(height_m(column - 1, row), here, height_m(column + 1, row), cell.east_m),
        slope(height_m(column, row + 1), here, height_m(column, row - 1), cell.north_m),
    ]
}

/// The rise in metres per metre from `before` to `after`, which are the nodes on both sides of
/// `here`.
fn slope(before: Option<f64>, here: Option<f64>, after: Option<f64>, cell_m: f64) -> f64 {
    match (before, here, after) {
        (Some(before), _, Some(after)) => (after - before) / (2.0 * cell_m),
        (Some(before), Some(here), None) => (here - before) / cell_m,
        (None, Some(here), Some(after)) => (after - here) / cell_m,
        _ => 0.0,
    }
}

/// Encodes a direction of any length, with z at or above 0, as a point of the octahedron's upper
/// half seen from above, in multiples of 2^`shift`.
///
/// Source: Meyer, Süßmuth, Sußner, Stamminger & Greiner 2010, *On Floating-Point Normal Vectors*,
/// section 3.
fn encode_normal([x, y, z]: [f64; 3], shift: u8) -> [i8; 2] {
    let length = x.abs() + y.abs() + z;
    let steps = STEPS / f64::from(1_u32 << shift);
    [x, y].map(|value| {
        // For a vertical wall, the last whole step is the nearest one that fits.
        ((value / length * steps).round().clamp(-steps.floor(), steps.floor()) as i8) << shift
    })
}

/// Number of steps from the centre of the octahedron's square to its edge.
const STEPS: f64 = 127.0;

/// Decodes the unit normal (x east, y north, z up) of a code from [`normals`]. Codes of −128 count
/// as −127.
///
/// Source: Meyer et al. 2010, *On Floating-Point Normal Vectors*, section 3; the lower half of the
/// octahedron, which terrain never uses, is folded outward.
#[must_use]
pub fn decode_normal(code: [i8; 2]) -> [f32; 3] {
    let [mut x, mut y] = code.map(|value| (f32::from(value) / STEPS as f32).max(-1.0));
    let z = 1.0 - x.abs() - y.abs();
    if z < 0.0 {
        (x, y) = ((1.0 - y.abs()).copysign(x), (1.0 - x.abs()).copysign(y));
    }
    let length = (x * x + y * y + z * z).sqrt();
    [x / length, y / length, z / length]
}

#[cfg(test)]
#[path = "normals_tests.rs"]
mod tests;
