//! Terrain tiles as bytes: quantized-mesh 1.0, little-endian.
//!
//! ```text
//!   header      centre, heights, sphere, horizon            88 bytes
//!   vertices    count; u, v, height: differences, zigzag    u16 each
//!   padding     to four bytes where indices have four
//!   triangles   count; high-water marks                     u16, u32 with more than 65 536 vertices
//!   edges       west, south, east, north: counts, indices
//!   extensions  1: normals, octahedral, 2 bytes a vertex;  4: metadata, JSON
//! ```

use super::{
    facets::MeshVertex,
    horizon::{occlusion_point, sphere},
    mesh::QuantizedTile,
    tiling::LAST_STEP,
};
use crate::surfaces::by_first_use;

/// The most vertices that indices of two bytes can refer to.
const MOST_OF_U16: usize = 65_536;
const NORMALS: u8 = 1;
const METADATA: u8 = 4;

/// The extension for normals, which all tiles have, with its name in layer.json.
pub(crate) const NORMALS_NAME: &str = "octvertexnormals";
/// The extension for metadata, which some tiles may have.
pub(crate) const METADATA_NAME: &str = "metadata";

/// Encodes a tile, without compression. `metadata` is JSON. A tile without a horizon occlusion
/// point gets NaN there, and viewers never treat it as hidden.
pub(crate) fn encode(mesh: &QuantizedTile, metadata: Option<&str>, has_horizon: bool) -> Vec<u8> {
    // Number the vertices by first use, as high-water marks require.
    let mut triangles = mesh.triangles.clone();
    let order = by_first_use(&mut triangles, mesh.vertices.len());
    let vertices: Vec<&MeshVertex> = order.iter().map(|&k| &mesh.vertices[k as usize]).collect();
    let mut bytes = Vec::with_capacity(200 + 8 * vertices.len() + 12 * triangles.len());
    let (middle_m, radius_m) = sphere(mesh);
    let horizon = if has_horizon { occlusion_point(mesh, middle_m) } else { [f64::NAN; 3] };
    doubles(&mut bytes, &middle_m);
    for height_m in mesh.range_m {
        bytes.extend(height_m.to_le_bytes());
    }
    doubles(&mut bytes, &middle_m);
    doubles(&mut bytes, &[radius_m]);
    doubles(&mut bytes, &horizon);
    word(&mut bytes, vertices.len());
    for field in
        [|v: &MeshVertex| v.steps[0], |v: &MeshVertex| v.steps[1], |v: &MeshVertex| v.height]
    {
        let mut last = 0;
        for vertex in &vertices {
            let value = i32::from(field(vertex));
            bytes.extend(zigzag(value - last).to_le_bytes());
            last = value;
        }
    }
    let is_wide = vertices.len() > MOST_OF_U16;
    while is_wide && !bytes.len().is_multiple_of(4) {
        bytes.push(0);
    }
    let index = |bytes: &mut Vec<u8>, value: u32| match u16::try_from(value) {
        Ok(value) if !is_wide => bytes.extend(value.to_le_bytes()),
        _ => bytes.extend(value.to_le_bytes()),
    };
    word(&mut bytes, triangles.len());
    let mut highest = 0;
    for corner in triangles.as_flattened() {
        index(&mut bytes, highest - corner);
        highest += u32::from(*corner == highest);
    }
    for edge in edges(&vertices) {
        word(&mut bytes, edge.len());
        for vertex in edge {
            index(&mut bytes, vertex);
        }
    }
    bytes.push(NORMALS);
    word(&mut bytes, 2 * vertices.len());
    for vertex in &vertices {
        bytes.extend(octahedral(vertex.normal));
    }
    if let Some(metadata) = metadata {
        bytes.push(METADATA);
        word(&mut bytes, 4 + metadata.len());
        word(&mut bytes, metadata.len());
        bytes.extend(metadata.as_bytes());
    }
    bytes
}

/// Returns the vertices on the west, south, east and north border, from the south and from the
/// west.
fn edges(vertices: &[&MeshVertex]) -> [Vec<u32>; 4] {
    [(0, 0), (1, 0), (0, LAST_STEP), (1, LAST_STEP)].map(|(across, border)| {
        let step = |k: u32, axis: usize| vertices[k as usize].steps[axis];
        let all = 0..vertices.len() as u32;
        let mut found: Vec<u32> = all.filter(|&k| step(k, across) == border).collect();
        found.sort_unstable_by_key(|&k| step(k, 1 - across));
        found
    })
}

/// Stores the sign of a difference in the lowest bit; differences of 15-bit values fit.
fn zigzag(difference: i32) -> u16 {
    ((difference << 1) ^ (difference >> 31)) as u16
}

/// Encodes a unit vector on an octahedron, 8 bits per axis.
///
/// Source: Cigolle et al. 2014, *A Survey of Efficient Representations for Independent Unit
/// Vectors*; CesiumJS decodes it in this way.
fn octahedral([x, y, z]: [f64; 3]) -> [u8; 2] {
    let sum = x.abs() + y.abs() + z.abs();
    let [mut p, mut q] = [x / sum, y / sum];
    if z < 0.0 {
        [p, q] = [(1.0 - q.abs()) * 1.0_f64.copysign(p), (1.0 - p.abs()) * 1.0_f64.copysign(q)];
    }
    [p, q].map(|axis| ((axis.clamp(-1.0, 1.0) * 0.5 + 0.5) * 255.0).round() as u8)
}

fn doubles(bytes: &mut Vec<u8>, values: &[f64]) {
    for value in values {
        bytes.extend(value.to_le_bytes());
    }
}

fn word(bytes: &mut Vec<u8>, value: usize) {
    bytes.extend((value as u32).to_le_bytes());
}

#[cfg(test)]
#[path = "encode_tests.rs"]
mod tests;
