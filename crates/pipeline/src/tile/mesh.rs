//! Triangulates the heights of a tile, and stores the TINs of coarse tiles as artifacts.

use corniche_geom::{HeightGrid, TileId};
use corniche_spec::{
    artifacts::{ArtifactError, ArtifactKind, damaged},
    levels::Levels,
};
use corniche_store::Artifacts;
use corniche_tin::{Tin, TinSpec, TinVertex};

use crate::BuildError;

/// A tile's ground as a mesh, before it is measured.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Meshed {
    pub(crate) tin: Tin,
    pub(crate) normals: Vec<[i8; 2]>,
}

/// Triangulates the heights of a tile (259 × 259 nodes, of which one on every side is halo). The
/// TIN is empty if no cell has ground.
pub(crate) fn mesh_tile(
    heights_with_halo: &HeightGrid,
    id: TileId,
    levels: &Levels,
) -> Result<Meshed, BuildError> {
    let spec = TinSpec { max_error_m: levels.max_error_m(id.z()), quantum_m: levels.quantum_m() };
    let tin = corniche_tin::triangulate(heights_with_halo, spec)
        .map_err(|source| BuildError::Triangulate { id, source })?;
    let cell = levels.frame().level_cell(id.z());
    let shift = corniche_tin::normal_shift(spec.max_error_m, cell);
    let normals = corniche_tin::normals(heights_with_halo, &tin, cell, shift);
    Ok(Meshed { tin, normals })
}

impl Meshed {
    pub(crate) fn put(&self, store: &dyn Artifacts, id: TileId) -> Result<(), ArtifactError> {
        Ok(store.put(ArtifactKind::Tin.of_tile(id), &to_bytes(self))?)
    }

    /// Reads the TIN of a coarse tile of the data; `None` if it is empty, so that the tile has no
    /// ground.
    pub(crate) fn get(store: &dyn Artifacts, id: TileId) -> Result<Option<Self>, ArtifactError> {
        let key = ArtifactKind::Tin.of_tile(id);
        let missing =
            || ArtifactError::Missing { what: format!("the TIN of tile {id}"), step: "top" };
        let bytes = store.get(key)?.ok_or_else(missing)?;
        let meshed = from_bytes(&bytes).ok_or_else(|| damaged(key, &"it is not a TIN"))?;
        Ok(Some(meshed).filter(|meshed| !meshed.tin.is_empty()))
    }
}

/// Encodes counts, then vertices (row, column, height), normals, triangles; all little-endian.
fn to_bytes(Meshed { tin, normals }: &Meshed) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(8 + tin.vertices().len() * 10 + tin.triangles().len() * 12);
    bytes.extend((tin.vertices().len() as u32).to_le_bytes());
    bytes.extend((tin.triangles().len() as u32).to_le_bytes());
    for vertex in tin.vertices() {
        bytes.extend(vertex.row.to_le_bytes());
        bytes.extend(vertex.column.to_le_bytes());
        bytes.extend(vertex.height_q.to_le_bytes());
    }
    bytes.extend(normals.iter().flatten().flat_map(|step| step.to_le_bytes()));
    bytes.extend(tin.triangles().iter().flatten().flat_map(|index| index.to_le_bytes()));
    bytes
}

fn from_bytes(bytes: &[u8]) -> Option<Meshed> {
    let (counts, rest) = bytes.split_first_chunk::<8>()?;
    let count = |at: usize| Some(u32::from_le_bytes(*counts[at..].first_chunk()?) as usize);
    let (vertices, triangles) = (count(0)?, count(4)?);
    let (vertex_bytes, rest) = rest.split_at_checked(vertices * 8)?;
    let (normal_bytes, triangle_bytes) = rest.split_at_checked(vertices * 2)?;
    if triangle_bytes.len() != triangles * 12 {
        return None;
    }
    let vertices =
        vertex_bytes.as_chunks::<8>().0.iter().map(|&[r0, r1, c0, c1, ref height @ ..]| {
            TinVertex {
                row: u16::from_le_bytes([r0, r1]),
                column: u16::from_le_bytes([c0, c1]),
                height_q: i32::from_le_bytes(*height),
            }
        });
    let normals = normal_bytes.as_chunks().0.iter().map(|step| step.map(u8::cast_signed));
    let corners = triangle_bytes.as_chunks().0.iter().map(|&corner| u32::from_le_bytes(corner));
    let corners: Vec<u32> = corners.collect();
    let (vertices, triangles) = (vertices.collect(), corners.as_chunks().0.to_vec());
    Some(Meshed { tin: Tin::from_canonical(vertices, triangles).ok()?, normals: normals.collect() })
}

#[cfg(test)]
#[path = "mesh_tests.rs"]
mod tests;
