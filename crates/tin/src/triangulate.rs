//! Triangulation of a tile: greedy insertion until every node lies within the error bound.

use corniche_geom::HeightGrid;
use spade::InsertionError;

use crate::boundary::stretches;
use crate::fixed_mesh::fixed_mesh;
use crate::refine::refine;
use crate::tile_raster::TileRaster;
use crate::to_tin::to_tin;
use crate::{Tin, TinError};

/// How closely a TIN follows its heights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TinSpec {
    /// No node the TIN covers lies farther from it, vertically; metres, above 0.
    pub max_error_m: f64,
    /// Height of one step of [`TinVertex::height_q`](crate::TinVertex::height_q), metres; above 0 and at most `max_error_m`.
    pub quantum_m: f64,
}

/// Why heights could not be triangulated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TriangulateError {
    /// Tolerance and quantum do not fit each other.
    #[error(
        "a max error of {max_error_m} m needs a height quantum above 0 and at most that, not {quantum_m} m"
    )]
    Spec {
        /// The tolerance asked for.
        max_error_m: f64,
        /// The quantum asked for.
        quantum_m: f64,
    },
    /// The grid is too small to hold a cell and its halo, or its nodes do not fit the indices of a vertex.
    #[error("a tile with its halo has 4 to 65538 columns and rows, not {columns} × {rows}")]
    Size {
        /// Columns given, halo included.
        columns: usize,
        /// Rows given, halo included.
        rows: usize,
    },
    /// A height is beyond what 32-bit steps of the quantum can hold.
    #[error(
        "a height of {height_m} m does not fit 32-bit steps of {quantum_m} m; is it a nodata value, or the \
         tolerance too small?"
    )]
    Height {
        /// The height.
        height_m: f32,
        /// The quantum.
        quantum_m: f64,
    },
    /// The triangulation library refused a node. Nodes are small integers, so this does not happen.
    #[error("a node of the grid could not be inserted")]
    Insert(#[from] InsertionError),
    /// The triangles do not make a TIN.
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

/// The largest power of two that is at most `max_error_m` / 32: the height quantum of a package.
///
/// 0 for a tolerance that is 0, negative or not a number.
#[must_use]
pub fn height_quantum_m(max_error_m: f64) -> f64 {
    let limit_m = max_error_m / 32.0;
    if !limit_m.is_normal() || limit_m < 0.0 {
        return 0.0;
    }
    // A float without its mantissa is the largest power of two not above it.
    f64::from_bits(limit_m.to_bits() & (0x7ff << 52))
}

/// The TIN of one tile: every node it covers lies within `spec.max_error_m` of it, vertically.
///
/// `heights` is the tile's raster with one more node on each side; vertices are counted without that halo.
/// Ground is where cells have four corners with heights; the TIN covers exactly that, and is empty where
/// there is none. Vertices on the border depend on the border's own heights and on the cells on both sides
/// of it, nothing else, so that two tiles share them bit for bit wherever both have ground.
///
/// Source: Garland & Heckbert 1995, *Fast Polygonal Approximation of Terrains and Height Fields*, algorithm
/// III (only changed triangles are rescanned), over a constrained Delaunay triangulation. What we changed:
/// residuals are taken against quantized vertices, border and boundaries are settled first, in one dimension,
/// and never added to.
///
/// # Errors
/// When tolerance and quantum do not fit each other, the grid has no cell inside its halo or is too large, or a
/// height does not fit 32-bit steps of the quantum.
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

/// A height farther from 0 than `most_m`, if there is one.
fn beyond(heights_m: &[f32], most_m: f64) -> Option<f32> {
    let is_beyond = |height_m: f32| f64::from(height_m).abs() > most_m;
    // Blocks are looked at as a whole, without a branch for each height.
    let block = heights_m
        .chunks(1 << 10)
        .find(|block| block.iter().fold(false, |any, &height_m| any | is_beyond(height_m)))?;
    block.iter().copied().find(|&height_m| is_beyond(height_m))
}

/// Nodes of a [`TinVertex`] are 16-bit, and there is a halo on both sides.
const MAX_SIDE: usize = 65_536 + 2;
