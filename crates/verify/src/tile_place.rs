//! Where a tile lies on the lattice.

use corniche_geom::{GridFrame, LatticePoint, NodeIndex, TILE_CELLS, TileId};

/// Where a tile lies on the lattice.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TilePlace {
    corner: LatticePoint,
    /// Lattice steps to a cell of the tile, east and north.
    pub steps: [f64; 2],
}

impl TilePlace {
    pub(crate) fn of(frame: &GridFrame, id: TileId) -> Self {
        let (corner, stride) = (frame.tile_corner(id), frame.stride(id.z()));
        let next = NodeIndex { i: corner.i + stride, j: corner.j + stride };
        let (from, to) = (frame.lattice_of_node(corner), frame.lattice_of_node(next));
        Self { corner: from, steps: [(to.u - from.u) as f64, (to.v - from.v) as f64] }
    }

    /// Steps east and north of the tile's corner. These numbers are small, so f64 holds their fractions exactly enough.
    pub(crate) fn local(&self, point: LatticePoint) -> [f64; 2] {
        [(point.u - self.corner.u) as f64, (point.v - self.corner.v) as f64]
    }

    /// The same for a position that is given in steps from the lattice's origin.
    pub(crate) fn local_of(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        [u - self.corner.u as f64, v - self.corner.v as f64]
    }

    /// Column and row, in cells of the tile, of a local position.
    pub(crate) fn cells(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        [u / self.steps[0], -v / self.steps[1]]
    }

    /// East and south end of the tile, in local steps: it reaches from 0 to the first, and from the second to 0.
    pub(crate) fn reach(&self) -> [f64; 2] {
        [TILE_CELLS as f64 * self.steps[0], -TILE_CELLS as f64 * self.steps[1]]
    }
}
