//! The numbers of cells and nodes along a side of a tile, and of levels of a package.

/// Number of cells along one side of a tile.
pub const TILE_CELLS: i64 = 256;
/// Number of nodes along one side of a tile; border nodes are shared with the neighbour.
pub const TILE_NODES: usize = 257;
/// Deepest level a package can have. 2^22 tiles of 256 cells keep node indices within 31 bits, and
/// with them every lattice coordinate well within 62 bits.
pub const MAX_LEVEL: u8 = 22;
