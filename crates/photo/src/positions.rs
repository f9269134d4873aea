//! The positions of texels among a photo's pixels.

use corniche_gis::{CrsError, RasterOnGrid};

use crate::TexelGrid;

/// Texels along a side of a mesh. Meshes belong to the global grid, so a texel's position depends
/// on nothing but its index.
pub(crate) const MESH: i64 = 32;
/// The largest error of a position, in texels and in pixels. If interpolation is worse, each texel
/// is transformed.
const TOLERANCE: f64 = 0.05;

/// The positions of a mesh's texels among the pixels of one photo.
///
/// ```text
///   o───·───o      o  corners      ·  halfway: where interpolation between corners is worst
///   │       │
///   ·   ·   ·      If the five halves agree with the bilinear mean of the corners, texels are
///   │       │      interpolated, else transformed.
///   o───·───o
/// ```
#[derive(Debug, Clone)]
pub(crate) struct MeshPositions {
    /// Column and row of the mesh, in meshes.
    at: [i64; 2],
    /// North-west, north-east, south-west, south-east.
    corners: [[f64; 2]; 4],
    /// Row by row, if they cannot be interpolated.
    exact: Option<Vec<[f64; 2]>>,
    /// Pixels along a texel, along columns and along rows of pixels; at least 1.
    pub(crate) radius: [f64; 2],
}

impl MeshPositions {
    /// Returns `None` if a corner or a half has no position in the photo's coordinate system.
    pub(crate) fn new(
        grid: &TexelGrid,
        photo: &RasterOnGrid,
        at: [i64; 2],
    ) -> Result<Option<Self>, CrsError> {
        let half = MESH / 2;
        let mut points: Vec<[f64; 2]> = (0..3)
            .flat_map(|row| (0..3).map(move |column| [column, row]))
            .map(|offset| {
                grid.position_m([0, 1].map(|axis| (at[axis] * MESH + offset[axis] * half) as f64))
            })
            .collect();
        photo.pixels_from_working(&mut points)?;
        if points.iter().flatten().any(|position| !position.is_finite()) {
            return Ok(None);
        }
        let corners = [points[0], points[2], points[6], points[8]];
        // The step of a texel along the mesh's middle.
        let step = |from: usize, to: usize| {
            [0, 1].map(|axis| (points[to][axis] - points[from][axis]) / MESH as f64)
        };
        let (east, south) = (step(3, 5), step(1, 7));
        let length = |a: f64, b: f64| (a * a + b * b).sqrt();
        let radius = [0, 1].map(|axis| length(east[axis], south[axis]).max(1.0));
        let texel_px = length(east[0], east[1]).min(length(south[0], south[1]));
        let tolerance_px = TOLERANCE * texel_px.min(1.0);
        let is_smooth =
            [(1, [0.5, 0.0]), (3, [0.0, 0.5]), (4, [0.5; 2]), (5, [1.0, 0.5]), (7, [0.5, 1.0])]
                .iter()
                .all(|&(point, share)| {
                    let mean = between(corners, share);
                    (0..2).all(|axis| (mean[axis] - points[point][axis]).abs() <= tolerance_px)
                });
        let mut positions = Self { at, corners, exact: None, radius };
        if !is_smooth {
            let mut all: Vec<[f64; 2]> = (0..MESH * MESH)
                .map(|k| [at[0] * MESH + k % MESH, at[1] * MESH + k / MESH])
                .map(|texel| grid.position_m(texel.map(|at| at as f64 + 0.5)))
                .collect();
            photo.pixels_from_working(&mut all)?;
            positions.exact = Some(all);
        }
        Ok(Some(positions))
    }

    /// The first texel of the mesh.
    pub(crate) fn first(&self) -> [i64; 2] {
        self.at.map(|at| at * MESH)
    }

    /// Returns the position of the centre of a texel of the mesh, in pixels; NaN if there is none.
    pub(crate) fn position_at(&self, [column, row]: [i64; 2]) -> [f64; 2] {
        match &self.exact {
            Some(exact) => exact[(row * MESH + column) as usize],
            None => between(self.corners, [column, row].map(|k| (k as f64 + 0.5) / MESH as f64)),
        }
    }

    /// The lowest and the highest position of the mesh, including the reach of the filter: pixels
    /// outside do not contribute to any texel.
    pub(crate) fn reach(&self) -> [[f64; 2]; 2] {
        let points = || self.corners.iter().chain(self.exact.iter().flatten());
        let finite = |axis: usize| {
            points().map(move |point| point[axis]).filter(|position| position.is_finite())
        };
        let low = [0, 1].map(|axis| finite(axis).fold(f64::INFINITY, f64::min) - self.radius[axis]);
        let high =
            [0, 1].map(|axis| finite(axis).fold(f64::NEG_INFINITY, f64::max) + self.radius[axis]);
        [low, high]
    }
}

/// Returns the bilinear mean of four corners.
fn between([nw, ne, sw, se]: [[f64; 2]; 4], [east, south]: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|axis| {
        let north = nw[axis] + (ne[axis] - nw[axis]) * east;
        let along_south = sw[axis] + (se[axis] - sw[axis]) * east;
        north + (along_south - north) * south
    })
}
