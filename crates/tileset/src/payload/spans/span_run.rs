//! A run of a bridge or tunnel as a tile holds it, and how high its points are.

use corniche_geom::LatticePoint;
use corniche_roads::{FunctionalRoadClass, Structure};
use corniche_tin::Surface;

/// A stretch of a way of a bridge that is above the ground of its tile, or of a tunnel that is below. Its heights are estimates.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SpanRun {
    /// OSM's id of the way.
    pub way_id: i64,
    /// Functional road class.
    pub class: FunctionalRoadClass,
    /// A bridge or a tunnel, never the ground.
    pub structure: Structure,
    /// At least two points; neighbours are different in plan. Only the first and the last may be on the ground.
    pub points: Vec<SpanPoint>,
}

impl SpanRun {
    /// The runs of a tile are in this order, and those of a way in the order in which they lie along it.
    pub(crate) fn key(&self) -> (FunctionalRoadClass, i64) {
        (self.class, self.way_id)
    }
}

/// A point of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SpanPoint {
    /// Where it is in plan.
    pub at: LatticePoint,
    /// How high it is.
    pub height: SpanHeight,
}

impl SpanPoint {
    /// Its height in metres, for a tile with this ground and a package with this height quantum; `None` if there is no such triangle.
    ///
    /// On the ground it is the height that a source point of a GEO road has there, to the last bit.
    #[must_use]
    pub fn height_m(&self, surface: &Surface, quantum_m: f64) -> Option<f64> {
        match self.height {
            SpanHeight::Steps(steps) => Some(steps as f64 * quantum_m),
            SpanHeight::Ground { triangle } => {
                let exists = (triangle as usize) < surface.triangles().len();
                exists.then(|| surface.height_at_point_m(triangle, self.at))
            }
        }
    }
}

/// How high a point of a run is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpanHeight {
    /// So many steps of the package's height quantum; within 32 bits, as heights of the ground are.
    Steps(i64),
    /// On the ground.
    Ground {
        /// The triangle of the tile's TIN in whose plane the point lies.
        triangle: u32,
    },
}
