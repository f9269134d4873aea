//! Heights of a package are carried to the ellipsoid of WGS84, which GeoJSON wants.

use corniche_dem::{RecordedCrs, RecordedHeights};
use corniche_tileset::Manifest;

use crate::OverlayError;

/// Carries heights of a package to the ellipsoid of WGS84, which GeoJSON wants (RFC 7946, section 4).
pub struct EllipsoidHeights(RecordedHeights);

impl EllipsoidHeights {
    /// What carries a package's heights; `None` if its vertical datum is unknown, or nothing here leads from it to the ellipsoid,
    /// such as a missing grid.
    ///
    /// # Errors
    /// When the package's coordinate system cannot be used.
    pub fn of(manifest: &Manifest) -> Result<Option<Self>, OverlayError> {
        let failed = |source| OverlayError::PackageCrs(Box::new(source));
        let Manifest { crs_wkt, metres_per_unit, data_bounds, vertical, settings, .. } = manifest;
        let crs = RecordedCrs::new(crs_wkt, *metres_per_unit, *data_bounds).map_err(failed)?;
        let given = [&settings.vertical_crs, &settings.dem_vertical_crs];
        let given: Vec<&str> = given.into_iter().flatten().map(String::as_str).collect();
        let found = RecordedHeights::find(&crs, &vertical.datum, &given, manifest.wgs84_bounds);
        let heights = found.map_err(failed)?.map(Self);
        let middle = [data_bounds.center()];
        Ok(heights.filter(|heights| heights.carry(&middle, &mut [vertical.range_m[0]])))
    }

    /// Replaces heights of the package at positions in its working CRS. Whether that can be done.
    #[must_use]
    pub fn carry(&self, positions_m: &[[f64; 2]], heights_m: &mut [f64]) -> bool {
        self.0.to_wgs84_m(positions_m, heights_m).is_ok()
            && heights_m.iter().all(|height_m| height_m.is_finite())
    }
}
