//! The ground of a tile that is shown, on which lines can be laid later.

use corniche_geom::{GridFrame, LatticePoint, MOST_TILE_STEPS, TileId, TooMuchWork};
use corniche_tileset::Manifest;
use corniche_tin::{Placement, Surface, Tin, TinVertex};

use super::{
    LayerLine, LineMethods, PlanScale, TileGeometry, TileLayer,
    line_layers::{TileGround, lay},
};

/// The ground of a tile that is shown, on which lines can be laid at any time.
///
/// It is made of the tile's triangles as they are drawn: their corners are nodes of the tile's raster, and their heights are whole steps,
/// so rounding gives the very TIN of the package back.
pub struct TileSurface {
    id: TileId,
    surface: Surface,
    reference_m: [f64; 3],
    width_margin_m: f64,
    scale: PlanScale,
    vertical_scale: f64,
}

impl TileSurface {
    /// The ground of a tile of a package; `None` if it has none.
    #[must_use]
    pub fn of(tile: &TileGeometry, manifest: &Manifest) -> Option<Self> {
        let frame = &manifest.frame;
        let quantum_m = manifest.vertical.quantum_m;
        let tin = tin_of(tile, frame, quantum_m)?;
        let scale = PlanScale::of_tile(
            &manifest.coordinates,
            frame.tile_bounds(tile.id),
            manifest.point_scale,
        );
        Some(Self {
            id: tile.id,
            surface: Surface::new(&tin, Placement::of_tile(frame, tile.id, quantum_m)),
            reference_m: tile.reference_m,
            width_margin_m: tile.width_margin_m,
            scale,
            vertical_scale: manifest.point_scale,
        })
    }

    /// True height of the ground at a point; `None` where there is none.
    #[must_use]
    pub fn height_m(&self, point: LatticePoint) -> Option<f64> {
        let triangle = self.surface.locate(point)?;
        Some(self.surface.height_at_point_m(triangle, point))
    }

    /// Lines on this ground.
    ///
    /// # Errors
    /// When they cross so many triangles that it would take too long.
    pub fn lay(
        &self,
        lines: &[LayerLine],
        frame: &GridFrame,
        methods: LineMethods,
    ) -> Result<TileLayer, TooMuchWork> {
        let on = TileGround {
            id: self.id,
            surface: &self.surface,
            frame,
            reference_m: self.reference_m,
            width_margin_m: self.width_margin_m,
            scale: &self.scale,
            vertical_scale: self.vertical_scale,
            most_steps: MOST_TILE_STEPS,
        };
        lay(lines, &on, methods)
    }
}

/// The TIN that a tile was made of.
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
