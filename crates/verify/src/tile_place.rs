//! The position of a tile on the lattice.

use corniche_geom::{GridFrame, LatticePoint, NodeIndex, TILE_CELLS, TileId};

/// The position of a tile on the lattice.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TilePlace {
    corner: LatticePoint,
    /// Lattice steps per cell of the tile, east and north.
    pub steps: [f64; 2],
}

impl TilePlace {
    pub(crate) fn from_frame(frame: &GridFrame, id: TileId) -> Self {
        let (corner, stride) = (frame.tile_corner(id), frame.stride(id.z()));
        let next = NodeIndex { i: corner.i + stride, j: corner.j + stride };
        let (from, to) = (frame.lattice_of_node(corner), frame.lattice_of_node(next));
        Self { corner: from, steps: [(to.u - from.u) as f64, (to.v - from.v) as f64] }
    }

    /// The steps east and north from the tile's corner to a point. These numbers are small, so f64
    /// holds their fractions exactly enough.
    pub(crate) fn local(&self, point: LatticePoint) -> [f64; 2] {
        [(point.u - self.corner.u) as f64, (point.v - self.corner.v) as f64]
    }

    /// The same for a position in steps from the lattice's origin.
    pub(crate) fn local_of(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        [u - self.corner.u as f64, v - self.corner.v as f64]
    }

    /// The column and row of a local position, in cells of the tile.
    pub(crate) fn cells(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        [u / self.steps[0], -v / self.steps[1]]
    }

    /// The east and south end of the tile, in local steps: the tile reaches from 0 to the first,
    /// and from the second to 0.
    pub(crate) fn reach(&self) -> [f64; 2] {
        [TILE_CELLS as f64 * self.steps[0], -TILE_CELLS as f64 * self.steps[1]]
    }
}
