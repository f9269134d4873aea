//! Triangulation of a tile: greedy insertion until every node is within the error bound.

use corniche_geom::HeightGrid;
use spade::InsertionError;

use crate::boundary::stretches;
use crate::fixed_mesh::fixed_mesh;
use crate::refine::refine;
use crate::tile_raster::TileRaster;
use crate::to_tin::to_tin;
use crate::{Tin, TinError};

/// The accuracy with which a TIN approximates its heights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TinSpec {
    /// The largest vertical distance of a covered node from the TIN, in metres, above 0.
    pub max_error_m: f64,
    /// The height of one step of [`TinVertex::height_q`](crate::TinVertex::height_q), in metres;
    /// above 0 and at most `max_error_m`.
    pub quantum_m: f64,
}

/// Why heights could not be triangulated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TriangulateError {
    /// The tolerance and the quantum do not match.
    #[error(
        "a max error of {max_error_m} m needs a height quantum above 0 m and at most {max_error_m} m, not {quantum_m} m"
    )]
    Spec {
        /// The requested tolerance.
        max_error_m: f64,
        /// The requested quantum.
        quantum_m: f64,
    },
    /// The grid is too small to contain a cell and its halo, or its nodes do not fit in the indices
    /// of a vertex.
    #[error("a tile with its halo has 4 to 65538 columns and rows, not {columns} × {rows}")]
    Size {
        /// The number of columns, halo included.
        columns: usize,
        /// The number of rows, halo included.
        rows: usize,
    },
    /// A height does not fit in 32-bit steps of the quantum.
    #[error(
        "a height of {height_m} m does not fit in 32-bit steps of {quantum_m} m; it may be a nodata value, or \
         the tolerance may be too small"
    )]
    Height {
        /// The height.
        height_m: f32,
        /// The quantum.
        quantum_m: f64,
    },
    /// The triangulation library rejected a node. Nodes are small integers, so this does not
    /// happen.
    #[error("a node of the grid could not be inserted")]
    Insert(#[from] InsertionError),
    /// The triangles do not form a TIN.
    #[error("the triangulation is inconsistent")]
    Tin(#[from] TinError),
}

impl TriangulateError {
    /// Whether the heights are the cause.
    #[must_use]
    pub fn is_unusable_input(&self) -> bool {
        matches!(self, Self::Height { .. })
    }
}

/// Returns the height quantum of a package: the largest power of two that is at most `max_error_m`
/// / 32.
///
/// Returns 0 for a tolerance that is 0, negative or NaN.
#[must_use]
pub fn height_quantum_m(max_error_m: f64) -> f64 {
    let limit_m = max_error_m / 32.0;
    if !limit_m.is_normal() || limit_m < 0.0 {
        return 0.0;
    }
    // A float without its mantissa is the largest power of two that is not above it.
    f64::from_bits(limit_m.to_bits() & (0x7ff << 52))
}

/// Triangulates one tile: every node that the TIN covers is within `spec.max_error_m` of it,
/// vertically.
///
/// `heights` is the tile's raster with one more node on each side; vertices are counted without
/// that halo. Cells whose four corners have heights are ground; the TIN covers exactly the ground,
/// and is empty without ground. Vertices on the border depend only on the border's own heights and
/// on the cells on both sides of it, so that two tiles share them bit for bit wherever both have
/// ground.
///
/// Source: Garland & Heckbert 1995, *Fast Polygonal Approximation of Terrains and Height Fields*,
/// algorithm III (only changed triangles are rescanned), over a constrained Delaunay triangulation.
/// What we changed: residuals are computed against quantized vertices; border and boundaries are
/// settled first, in one dimension, and never get more vertices.
///
/// # Errors
/// When tolerance and quantum do not match, the grid has no cell inside its halo or is too large,
/// or a height does not fit in 32-bit steps of the quantum.
pub fn triangulate(heights: &HeightGrid, spec: TinSpec) -> Result<Tin, TriangulateError> {
    let TinSpec { max_error_m, quantum_m } = spec;
    if !(quantum_m > 0.0 && quantum_m <= max_error_m && max_error_m.is_finite()) {
        return Err(TriangulateError::Spec { max_error_m, quantum_m });
    }
    let (columns, rows) = (heights.columns(), heights.rows());
    if !(4..=MAX_SIDE).contains(&columns) || !(4..=MAX_SIDE).contains(&rows) {
        return Err(TriangulateError::Size { columns, rows });
    }
    if let Some(height_m) = beyond(heights.raw(), f64::from(i32::MAX - 1) * quantum_m) {
        return Err(TriangulateError::Height { height_m, quantum_m });
    }

    let tile = TileRaster::new(heights, quantum_m);
    if tile.count_ground_cells() == 0 {
        return Ok(Tin::default());
    }
    let fixed = stretches(&tile, max_error_m, quantum_m);
    let mut mesh = fixed_mesh(&tile, &fixed)?;
    refine(&mut mesh, &tile, max_error_m, quantum_m);
    Ok(to_tin(&mesh, &tile)?)
}

/// Returns a height farther from 0 than `most_m`, if there is one.
fn beyond(heights_m: &[f32], most_m: f64) -> Option<f32> {
    let is_beyond = |height_m: f32| f64::from(height_m).abs() > most_m;
    // Blocks are tested as a whole, without a branch for each height.
    let block = heights_m
        .chunks(1 << 10)
        .find(|block| block.iter().fold(false, |any, &height_m| any | is_beyond(height_m)))?;
    block.iter().copied().find(|&height_m| is_beyond(height_m))
}

/// Nodes of a [`TinVertex`] are 16-bit, and there is a halo on both sides.
const MAX_SIDE: usize = 65_536 + 2;
