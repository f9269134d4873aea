//! A node of the tile's raster as a vertex of the triangulation.

use spade::{HasPosition, Point2};

use crate::TinVertex;
use crate::tile_raster::TileRaster;

/// A vertex of the mesh. To it, x is the column and y the row, which grows to the south.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Node {
    pub(crate) column: u16,
    pub(crate) row: u16,
    pub(crate) height_q: i32,
}

impl Node {
    pub(crate) fn new(tile: &TileRaster<'_>, [column, row]: [usize; 2]) -> Self {
        Self { column: column as u16, row: row as u16, height_q: tile.height_q([column, row]) }
    }

    pub(crate) fn to_vertex(self) -> TinVertex {
        TinVertex { row: self.row, column: self.column, height_q: self.height_q }
    }
}

impl HasPosition for Node {
    type Scalar = f64;

    #[inline]
    fn position(&self) -> Point2<f64> {
        Point2::new(f64::from(self.column), f64::from(self.row))
    }
}
