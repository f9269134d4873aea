//! A run of a bridge or tunnel in a tile, and the heights of its points.

use corniche_geom::LatticePoint;
use corniche_roads::{FunctionalRoadClass, Structure};
use corniche_tin::Surface;

/// A stretch of a way of a bridge that is above the ground of its tile, or of a tunnel that is
/// below the ground. Its heights are estimates.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SpanRun {
    /// OSM's id of the way.
    pub way_id: i64,
    /// Functional road class.
    pub class: FunctionalRoadClass,
    /// The structure: a bridge or a tunnel, never the ground.
    pub structure: Structure,
    /// At least two points; neighbouring points differ in plan. Only the first and the last may be
    /// on the ground.
    pub points: Vec<SpanPoint>,
}

impl SpanRun {
    /// The sort key of the runs of a tile; runs of one way are in their order along the way.
    pub(crate) fn key(&self) -> (FunctionalRoadClass, i64) {
        (self.class, self.way_id)
    }
}

/// A point of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SpanPoint {
    /// The position in plan.
    pub at: LatticePoint,
    /// The height.
    pub height: SpanHeight,
}

impl SpanPoint {
    /// The height in metres, for a tile with this ground and a package with this height quantum;
    /// `None` if the triangle does not exist.
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

/// The height of a point of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpanHeight {
    /// The height in steps of the package's height quantum; within 32 bits, like heights of the
    /// ground.
    Steps(i64),
    /// On the ground.
    Ground {
        /// The triangle of the tile's TIN whose plane contains the point.
        triangle: u32,
    },
}
