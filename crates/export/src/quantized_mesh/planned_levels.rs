//! The levels that an export of terrain tiles will write.

use std::collections::BTreeSet;

use super::tiling::TerrainTile;

/// What an export of terrain tiles will write.
#[derive(Debug, Clone)]
pub struct QuantizedMeshPlan {
    /// Each level, coarsest first.
    pub levels: Vec<PlannedLevel>,
    /// Bytes of all files, estimated from some tiles.
    pub bytes: u64,
    /// The tiles of the finest level.
    pub(crate) candidates: BTreeSet<TerrainTile>,
}

/// What will be written of a level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlannedLevel {
    /// The level.
    pub level: u8,
    /// The most tiles that it can have: those without ground are left out.
    pub tiles: u64,
    /// How long one takes, in those of the finest level.
    pub effort: f64,
}
