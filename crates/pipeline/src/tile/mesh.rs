//! Triangulates the heights of a tile, and stores the TINs of coarse tiles as artifacts.

use corniche_geom::{HeightGrid, TileId};
use corniche_spec::{
    artifacts::{self, ArtifactError, ArtifactKind, damaged},
    levels::Levels,
};
use corniche_store::Artifacts;
use corniche_tin::{Tin, TinSpec, TinVertex};

use crate::BuildError;

/// A tile's ground as a mesh, before it is measured.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Meshed {
    pub tin: Tin,
    pub normals: Vec<[i8; 2]>,
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

/// The rows, columns and heights of vertices; normals; triangles.
type MeshRecord = (Vec<(u16, u16, i32)>, Vec<[i8; 2]>, Vec<[u32; 3]>);

impl Meshed {
    /// Stores the mesh of a tile.
    pub(crate) fn put(&self, store: &dyn Artifacts, id: TileId) -> Result<(), ArtifactError> {
        let Self { tin, normals } = self;
        let vertex = |vertex: &TinVertex| (vertex.row, vertex.column, vertex.height_q);
        let vertices: Vec<_> = tin.vertices().iter().map(vertex).collect();
        artifacts::put(store, ArtifactKind::Tin.of_tile(id), &(vertices, normals, tin.triangles()))
    }

    /// Reads the mesh of a tile; `None` if it has no ground.
    pub(crate) fn get(store: &dyn Artifacts, id: TileId) -> Result<Option<Self>, ArtifactError> {
        let key = ArtifactKind::Tin.of_tile(id);
        let missing =
            || ArtifactError::Missing { what: format!("the TIN of tile {id}"), step: "top" };
        let (vertices, normals, triangles): MeshRecord =
            artifacts::get(store, key)?.ok_or_else(missing)?;
        let vertex = |(row, column, height_q)| TinVertex { row, column, height_q };
        let tin = Tin::from_canonical(vertices.into_iter().map(vertex).collect(), triangles);
        let tin = tin.ok().filter(|tin| tin.vertices().len() == normals.len());
        let tin = tin.ok_or_else(|| damaged(key, &"it is not a TIN"))?;
        Ok((!tin.is_empty()).then_some(Self { tin, normals }))
    }
}

#[cfg(test)]
#[path = "mesh_tests.rs"]
mod tests;
