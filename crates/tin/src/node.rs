//! A node of the tile's raster, as a corner of faces and as a vertex of spade's triangulation.

use spade::{HasPosition, Point2};

/// The position of a node as `row << 16 | column`, so that nodes have the same order as the
/// vertices of a TIN.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct GridNode(u32);

impl GridNode {
    pub(crate) fn new(column: u16, row: u16) -> Self {
        Self(u32::from(row) << 16 | u32::from(column))
    }

    pub(crate) fn column(self) -> u16 {
        self.0 as u16
    }

    pub(crate) fn row(self) -> u16 {
        (self.0 >> 16) as u16
    }
}

/// For spade, x is the column and y is the row, which grows to the south.
impl HasPosition for GridNode {
    type Scalar = f64;

    #[inline]
    fn position(&self) -> Point2<f64> {
        Point2::new(f64::from(self.column()), f64::from(self.row()))
    }
}
