//! The interface of projections between WGS84 and working metres.

use crate::Seam;

/// Why positions could not be projected.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("cannot transform coordinates: {reason}")]
pub struct ProjectError {
    /// What the projection library says.
    pub reason: String,
}

/// Longitude and latitude (WGS84, degrees, that order) ⇄ the working CRS (x east, y north, metres).
///
/// Degrees enter the geometry only here. Positions outside the projection's range come out as NaN.
pub trait Projection {
    /// Replaces each `[lon_deg, lat_deg]` by `[x_m, y_m]`.
    ///
    /// # Errors
    /// When the transformation as a whole cannot be carried out.
    fn working_from_wgs84(&self, points: &mut [[f64; 2]]) -> Result<(), ProjectError>;

    /// Replaces each `[x_m, y_m]` by `[lon_deg, lat_deg]`.
    ///
    /// # Errors
    /// When the transformation as a whole cannot be carried out.
    fn wgs84_from_working(&self, points: &mut [[f64; 2]]) -> Result<(), ProjectError>;

    /// The seam of the working CRS, in working metres, where x comes back after a turn around the earth. Positions come out on the map
    /// that ends there; lines between them are for [`Seam::split`].
    fn seam(&self) -> Option<Seam> {
        None
    }
}
