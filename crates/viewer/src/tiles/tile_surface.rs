//! The ground of a displayed tile, on which lines can be draped later.

use corniche_geom::{GridFrame, MOST_TILE_STEPS};
use corniche_tileset::Manifest;
use corniche_tin::{Tin, TinVertex};

use super::{PlanScale, TileGeometry, TileSurface};

impl TileSurface {
    /// The ground of a displayed tile; `None` if it has none.
    ///
    /// It is built from the drawn triangles: their corners are nodes of the tile's raster, and
    /// their heights are whole steps, so rounding restores the exact TIN of the package.
    #[must_use]
    pub fn from_geometry(tile: &TileGeometry, manifest: &Manifest) -> Option<Self> {
        let tin = tin_of(tile, &manifest.frame, manifest.vertical.quantum_m)?;
        Some(Self::new(tile, &tin, manifest))
    }

    /// The ground of a tile of a package with this TIN.
    pub(crate) fn new(tile: &TileGeometry, tin: &Tin, manifest: &Manifest) -> Self {
        let Manifest { frame, coordinates, point_scale, .. } = manifest;
        Self {
            id: tile.id,
            surface: manifest.surface(tile.id, tin),
            frame: *frame,
            quantum_m: manifest.vertical.quantum_m,
            reference_m: tile.reference_m,
            width_margin_m: tile.width_margin_m,
            scale: PlanScale::of_tile(coordinates, frame.tile_bounds(tile.id), *point_scale),
            vertical_scale: *point_scale,
            most_steps: MOST_TILE_STEPS,
        }
    }
}

/// Restores the TIN of a tile.
fn tin_of(tile: &TileGeometry, frame: &GridFrame, quantum_m: f64) -> Option<Tin> {
    let mesh = &tile.ground;
    let triangles = mesh.indices[..mesh.surface_indices].as_chunks::<3>().0;
    let count = triangles.as_flattened().iter().max().map_or(0, |last| *last as usize + 1);
    let corner = frame.tile_corner(tile.id);
    let stride = frame.stride(tile.id.z());
    let vertices: Option<Vec<TinVertex>> = mesh.vertices[..count]
        .iter()
        .map(|vertex| {
            let [x, y, z] = [0, 1, 2]
                .map(|axis| f64::from(vertex.position_in_tile[axis]) + tile.reference_m[axis]);
            let node = |at: f64, first: f64| ((at - first).abs() / stride as f64).round() as u16;
            let cell = frame.cell();
            let column = node(x / cell.east_m, frame.x_m(corner.i) / cell.east_m);
            let row = node(y / cell.north_m, frame.y_m(corner.j) / cell.north_m);
            let height_q = (z / quantum_m).round() as i32;
            Some(TinVertex { row, column, height_q })
        })
        .collect();
    Tin::new(vertices?, triangles).ok()
}

#[cfg(test)]
#[path = "tile_surface_tests.rs"]
mod tests;
