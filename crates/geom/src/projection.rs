//! The interface of projections between WGS84 and working metres.

use crate::Seam;

/// Why positions could not be projected.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("cannot transform coordinates: {reason}")]
pub struct ProjectError {
    /// The error of the projection library.
    pub reason: String,
}

/// Converts longitude and latitude (WGS84, degrees, in this order) ⇄ the working CRS (x east, y
/// north, metres).
///
/// Degrees enter the geometry only here. Positions outside the projection's range become NaN.
pub trait Projection {
    /// Replaces each `[lon_deg, lat_deg]` by `[x_m, y_m]`.
    ///
    /// # Errors
    /// When the transformation as a whole fails.
    fn working_from_wgs84(&self, points: &mut [[f64; 2]]) -> Result<(), ProjectError>;

    /// Replaces each `[x_m, y_m]` by `[lon_deg, lat_deg]`.
    ///
    /// # Errors
    /// When the transformation as a whole fails.
    fn wgs84_from_working(&self, points: &mut [[f64; 2]]) -> Result<(), ProjectError>;

    /// The seam of the working CRS, in working metres, at which x repeats after a turn around the
    /// earth. Positions are on the map that ends there; [`Seam::split`] cuts lines between them.
    fn seam(&self) -> Option<Seam> {
        None
    }
}
