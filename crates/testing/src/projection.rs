//! A projection of a flat world, which is exact enough for closed forms in tests.

use corniche_geom::{ProjectError, Projection};

/// A flat world: working metres are degrees from an origin times a factor per axis, plus the
/// origin's metres.
#[derive(Debug, Clone, Copy)]
pub struct FlatProjection {
    /// Working metres of the origin.
    pub origin_m: [f64; 2],
    /// Longitude and latitude of the origin.
    pub origin_deg: [f64; 2],
    /// Working metres per degree of longitude and of latitude.
    pub metres_per_degree: [f64; 2],
}

impl FlatProjection {
    /// Creates a projection in which 0 m is at 0°.
    #[must_use]
    pub fn new(metres_per_degree: [f64; 2]) -> Self {
        Self { origin_m: [0.0; 2], origin_deg: [0.0; 2], metres_per_degree }
    }
}

impl Projection for FlatProjection {
    fn working_from_wgs84(&self, points: &mut [[f64; 2]]) -> Result<(), ProjectError> {
        for point in points {
            *point = [0, 1].map(|axis| {
                self.origin_m[axis]
                    + (point[axis] - self.origin_deg[axis]) * self.metres_per_degree[axis]
            });
        }
        Ok(())
    }

    fn wgs84_from_working(&self, points: &mut [[f64; 2]]) -> Result<(), ProjectError> {
        for point in points {
            *point = [0, 1].map(|axis| {
                self.origin_deg[axis]
                    + (point[axis] - self.origin_m[axis]) / self.metres_per_degree[axis]
            });
        }
        Ok(())
    }
}
