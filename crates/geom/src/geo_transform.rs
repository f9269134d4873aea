//! The affine map from pixels of a raster to coordinates, and back.

use serde::{Deserialize, Serialize};

/// Affine map from pixel coordinates (column, row; 0 at the outer corner of the first pixel, row 0
/// in the north of a north-up raster) to CRS coordinates, in GDAL's order of coefficients:
///
/// ```text
/// x = c0 + c1 · column + c2 · row
/// y = c3 + c4 · column + c5 · row
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct GeoTransform {
    /// `[c0, c1, c2, c3, c4, c5]` as above.
    pub coefficients: [f64; 6],
}

impl GeoTransform {
    /// Converts a pixel position to a CRS position; the centre of pixel (0, 0) is `[0.5, 0.5]`.
    #[must_use]
    pub fn crs_from_pixel(&self, [column, row]: [f64; 2]) -> [f64; 2] {
        let c = &self.coefficients;
        [c[0] + c[1] * column + c[2] * row, c[3] + c[4] * column + c[5] * row]
    }

    /// Converts a CRS position to a pixel position; `None` if the transform is not invertible.
    #[must_use]
    pub fn pixel_from_crs(&self, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        let c = &self.coefficients;
        let determinant = c[1] * c[5] - c[2] * c[4];
        if determinant == 0.0 || !determinant.is_finite() {
            return None;
        }
        let (dx, dy) = (x - c[0], y - c[3]);
        Some([(dx * c[5] - dy * c[2]) / determinant, (dy * c[1] - dx * c[4]) / determinant])
    }

    /// Whether rows run along x and columns along y, without rotation or shear.
    #[must_use]
    pub fn is_axis_parallel(&self) -> bool {
        self.coefficients[2] == 0.0 && self.coefficients[4] == 0.0
    }
}

#[cfg(test)]
#[path = "geo_transform_tests.rs"]
mod tests;
