//! The fixed part of the section, and what its numbers may be.

use corniche_geom::Cell;
use serde::{Deserialize, Serialize};

use crate::manifest::check::MAX_MEASURE_M;

/// Bytes of a [`Record`] in bincode's legacy layout.
pub(crate) const RECORD_BYTES: usize = 49;

/// The fixed part of the section, in `bincode`'s legacy layout: fields in order, little-endian, fixed width.
#[derive(Serialize, Deserialize)]
pub(crate) struct Record {
    pub(crate) geometric_error_m: f64,
    pub(crate) height_range_m: [f64; 2],
    pub(crate) uncovered_nodes: u64,
    pub(crate) vertices: u32,
    pub(crate) triangles: u32,
    /// Bytes of the walk's symbols.
    pub(crate) symbols: u32,
    /// Bytes of the vertices that the walk names.
    pub(crate) named: u32,
    /// All heights are multiples of 2^this steps: a DEM in whole metres has no finer ones.
    pub(crate) height_shift: u8,
}

/// What turns slopes of the TIN, in height steps per node, into metres per metre.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scale {
    pub(crate) quantum_m: f64,
    /// The level's.
    pub(crate) cell: Cell,
    /// No more full-resolution nodes than this lie beneath the tile, border nodes of its finest tiles counted for each.
    pub(crate) nodes_beneath: u64,
}

/// Checks what a tile states about itself: the numbers must be finite, so that later code need not check, and
/// possible.
pub(crate) fn check_measures(
    geometric_error_m: f64,
    height_range_m: [f64; 2],
    uncovered_nodes: u64,
    scale: Scale,
) -> Result<(), &'static str> {
    if !(0.0..=MAX_MEASURE_M).contains(&geometric_error_m) {
        return Err("the geometric error");
    }
    let [low, high] = height_range_m;
    if !(low <= high && low >= -MAX_MEASURE_M && high <= MAX_MEASURE_M) {
        return Err("the height range");
    }
    if uncovered_nodes > scale.nodes_beneath {
        return Err("the number of uncovered nodes");
    }
    Ok(())
}
