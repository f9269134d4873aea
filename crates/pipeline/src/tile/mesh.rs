//! Heights of a tile to its TIN, and the TINs of coarse tiles as artifacts.

use corniche_geom::{HeightGrid, TileId};
use corniche_spec::{
    artifacts::{ArtifactError, Kind, damaged},
    levels::Levels,
};
use corniche_store::Artifacts;
use corniche_tin::{Tin, TinSpec, TinVertex};

use crate::BuildError;

/// A tile's ground as meshed, before it is measured.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Meshed {
    pub(crate) tin: Tin,
    pub(crate) normals: Vec<[i8; 2]>,
}

/// Triangulates the heights of a tile (259 × 259 nodes, one of them halo on every side). The TIN is empty where no cell has
/// ground.
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
        Ok(store.put(Kind::Tin.of_tile(id), &to_bytes(self))?)
    }

    /// The TIN of a coarse tile of the data; `None` where it is empty: the tile has no ground.
    pub(crate) fn get(store: &dyn Artifacts, id: TileId) -> Result<Option<Self>, ArtifactError> {
        let key = Kind::Tin.of_tile(id);
        let missing =
            || ArtifactError::Missing { what: format!("the TIN of tile {id}"), step: "top" };
        let bytes = store.get(key)?.ok_or_else(missing)?;
        let meshed = from_bytes(&bytes).ok_or_else(|| damaged(key, &"it is no TIN"))?;
        Ok(Some(meshed).filter(|meshed| !meshed.tin.is_empty()))
    }
}

/// Counts, then vertices (row, column, height), normals, triangles; all little-endian.
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
    let word = |bytes: &[u8]| Some(u32::from_le_bytes(bytes.try_into().ok()?));
    let half = |bytes: &[u8]| Some(u16::from_le_bytes(bytes.try_into().ok()?));
    let (counts, rest) = bytes.split_at_checked(8)?;
    let (vertices, triangles) = (word(&counts[..4])? as usize, word(&counts[4..])? as usize);
    let (vertex_bytes, rest) = rest.split_at_checked(vertices * 8)?;
    let (normal_bytes, triangle_bytes) = rest.split_at_checked(vertices * 2)?;
    if triangle_bytes.len() != triangles * 12 {
        return None;
    }
    let vertices = vertex_bytes
        .chunks_exact(8)
        .map(|b| {
            Some(TinVertex {
                row: half(&b[..2])?,
                column: half(&b[2..4])?,
                height_q: word(&b[4..])?.cast_signed(),
            })
        })
        .collect::<Option<Vec<_>>>()?;
    let normals =
        normal_bytes.chunks_exact(2).map(|b| [b[0].cast_signed(), b[1].cast_signed()]).collect();
    let triangles = triangle_bytes
        .chunks_exact(12)
        .map(|b| Some([word(&b[..4])?, word(&b[4..8])?, word(&b[8..])?]))
        .collect::<Option<Vec<_>>>()?;
    Some(Meshed { tin: Tin::from_canonical(vertices, triangles).ok()?, normals })
}

#[cfg(test)]
#[path = "mesh_tests.rs"]
mod tests;
