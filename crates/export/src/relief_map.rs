//! The relief of a tile as a normal map of its ground.
//!
//! Programs apply a normal map to the normals that they interpolate between the vertices of a
//! triangle. Each texel therefore contains the relief's normal relative to the interpolated one:
//! the shading shows the relief, and a program without support for normal maps still has the
//! vertices' own normals.
//!
//! Source: Khronos Group, *glTF 2.0 Specification*, section 3.9.3 (`normalTexture`) and 3.7.2.1
//! (`TANGENT`).

use corniche_geom::{LatticeBounds, TILE_NODES, TileId};
use corniche_tileset::{FilePackage, Relief};
use image::{ExtendedColorType, ImageEncoder, codecs::png};

use crate::{
    error::SurfaceError,
    globe::cross,
    plane::doubled_area,
    surfaces::{LabelledMesh, unit},
};

/// A normal map with a texel for each grid node of a tile.
pub(crate) struct ReliefMap {
    /// Red, green and blue in glTF's form: along the tangent (east), northwards, and away from the
    /// ground.
    pub(crate) png: Vec<u8>,
}

/// Texels on a side.
const SIDE: usize = TILE_NODES;
/// Smaller values count as 0.
const LEVEL: f32 = 1e-5;
/// The least component of a texel away from the ground: the first step above half.
const LEAST_AWAY: f32 = 0.005;
/// A grid node within this distance of a triangle edge counts as on it, to allow for rounding.
const EDGE: f64 = 1e-9;

impl ReliefMap {
    /// Returns the normal map of a tile with the ground `mesh`, including its normals; `None` if
    /// the package has no relief there.
    pub(crate) fn of_tile(
        package: &FilePackage,
        id: TileId,
        relief: Option<&Relief>,
        mesh: &LabelledMesh,
    ) -> Result<Option<Self>, SurfaceError> {
        let Some(relief) = relief else { return Ok(None) };
        let manifest = package.manifest();
        let cell = manifest.levels[usize::from(id.z())].cell_m;
        let vertices = mixed_normals(&manifest.frame.tile_lattice_bounds(id), mesh);
        let texels: Vec<u8> = relief
            .slopes(cell)
            .zip(vertices)
            .flat_map(|([east, north], vertex)| {
                let normal = unit([-east as f32, -north as f32, 1.0]);
                texel(seen_from(vertex, normal))
            })
            .collect();
        let mut png = Vec::new();
        let encoder = png::PngEncoder::new_with_quality(
            &mut png,
            // With the best compression, files are as large, and a model took 1.5 times as long
            // (docs/lab/exports.md).
            png::CompressionType::Fast,
            png::FilterType::Adaptive,
        );
        encoder
            .write_image(&texels, SIDE as u32, SIDE as u32, ExtendedColorType::Rgb8)
            .map_err(|source| SurfaceError::Relief { tile: id, source: Box::new(source) })?;
        Ok(Some(Self { png }))
    }

    /// Returns the texture coordinates of a place of the tile, given as shares of the tile from the
    /// west and from the north. Nodes are in the middle of their texels, so both tiles of a border
    /// read the same.
    pub(crate) fn place(across: [f32; 2]) -> [f32; 2] {
        let side = SIDE as f32;
        across.map(|share| (share * (side - 1.0) + 0.5) / side)
    }
}

/// Returns the tangent of a vertex: east, along the ground. All are vectors of east, north and up.
pub(crate) fn tangent([east, north, up]: [f32; 3]) -> [f32; 3] {
    // The part of (1, 0, 0) perpendicular to the normal. It vanishes where the ground is a wall
    // that faces east or west.
    let part = [1.0 - east * east, -east * north, -east * up];
    if part[0] > f32::EPSILON { unit(part) } else { [0.0, 0.0, -east.signum()] }
}

/// Returns the components of a direction along the tangent of a vertex, perpendicular to it, and
/// along the vertex normal.
fn seen_from(vertex: [f32; 3], direction: [f32; 3]) -> [f32; 3] {
    let along = tangent(vertex);
    let aside = cross(vertex, along);
    [along, aside, vertex].map(|axis| (0..3).map(|k| axis[k] * direction[k]).sum())
}

/// Encodes a normal as a texel. No texel points into the ground: glTF does not allow such normals.
fn texel([along, aside, away]: [f32; 3]) -> [u8; 3] {
    // Between 127 and 128, rounding alone would decide, and differently in two tiles.
    let level = |axis: f32| if axis.abs() < LEVEL { 0.0 } else { axis };
    let [x, y, z] = unit([level(along), level(aside), away.max(LEAST_AWAY)]);
    [x, y, z].map(|axis| ((axis + 1.0) * 127.5).round() as u8)
}

/// Returns the normal that a program interpolates between vertices at each node, by row from the
/// north; upwards where there is no ground.
fn mixed_normals(bounds: &LatticeBounds, mesh: &LabelledMesh) -> Vec<[f32; 3]> {
    let steps = [bounds.max.u - bounds.min.u, bounds.max.v - bounds.min.v]
        .map(|side| side as f64 / (SIDE - 1) as f64);
    let among_nodes = |corner: u32| {
        let [u, v] = mesh.on_lattice(&mesh.vertices[corner as usize]);
        [(u - bounds.min.u as f64) / steps[0], (bounds.max.v as f64 - v) / steps[1]]
    };
    let mut normals = vec![[0.0, 0.0, 1.0]; SIDE * SIDE];
    let on_ground = |corners: &&[u32; 3]| !mesh.vertices[corners[0] as usize].on_slab;
    for triangle in mesh.triangles.iter().filter(on_ground) {
        let [a, b, c] = triangle.map(among_nodes);
        let doubled = doubled_area([a, b, c]);
        if doubled.abs() < f64::MIN_POSITIVE {
            continue;
        }
        let range = |axis: usize| {
            let ends = [a[axis].min(b[axis]).min(c[axis]), a[axis].max(b[axis]).max(c[axis])];
            let last = (SIDE - 1) as f64;
            let low = (ends[0] - EDGE).ceil().clamp(0.0, last) as usize;
            low..=(ends[1] + EDGE).floor().clamp(0.0, last) as usize
        };
        for row in range(1) {
            for column in range(0) {
                let node = [column as f64, row as f64];
                let of_b = doubled_area([a, node, c]) / doubled;
                let of_c = doubled_area([a, b, node]) / doubled;
                let shares = [1.0 - of_b - of_c, of_b, of_c];
                if shares.iter().any(|share| *share < -EDGE) {
                    continue;
                }
                let mixed = [0, 1, 2].map(|axis: usize| {
                    let parts = triangle.iter().zip(shares);
                    parts
                        .map(|(corner, share)| {
                            mesh.vertices[*corner as usize].normal[axis] * share as f32
                        })
                        .sum()
                });
                normals[row * SIDE + column] = unit(mixed);
            }
        }
    }
    normals
}

#[cfg(test)]
#[path = "relief_map_tests.rs"]
mod tests;
