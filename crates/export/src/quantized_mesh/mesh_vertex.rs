//! A corner of a tile's triangles.

use spade::{HasPosition, Point2};

use crate::globe::geocentric_m;

/// A corner of triangles, in whole steps of the tile.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MeshVertex {
    pub(crate) u: u16,
    pub(crate) v: u16,
    /// Longitude, latitude and height above the ellipsoid.
    pub(crate) place: [f64; 3],
    /// The height in 32 767ths of the range, once the mesh is finished.
    pub(crate) height: u16,
    /// The position from the earth's centre.
    pub(crate) at_m: [f64; 3],
    /// The normal of the ground, in the same axes.
    pub(crate) normal: [f64; 3],
}

impl HasPosition for MeshVertex {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        Point2::new(f64::from(self.u), f64::from(self.v))
    }
}

impl MeshVertex {
    pub(crate) fn new([u, v]: [u16; 2], place: [f64; 3], normal: [f64; 3]) -> Self {
        Self { u, v, place, height: 0, at_m: geocentric_m(place), normal }
    }
}
