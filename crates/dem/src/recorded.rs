use corniche_geom::Bounds;

use crate::crs::Crs;
use crate::operation::Operation;
use crate::{DemError, DemProjection, scale};

/// The working CRS of a package, from what the package records of it: without the elevation files.
#[derive(Debug, Clone)]
pub struct RecordedCrs {
    crs: Crs,
}

impl RecordedCrs {
    /// From a WKT, or from a code such as "EPSG:32632".
    ///
    /// # Errors
    /// When PROJ cannot read it, or it is neither projected nor geographic.
    pub fn new(text: &str) -> Result<Self, DemError> {
        Ok(Self { crs: Crs::from_text("the package's", text)?.0 })
    }

    /// "EPSG:…" where it has a code, else its name.
    #[must_use]
    pub fn label(&self) -> &str {
        &self.crs.label
    }

    /// WGS84 ⇄ this CRS over a rectangle in degrees: the same positions, to the last bit, as when the package was built
    /// with the same rectangle.
    ///
    /// # Errors
    /// When PROJ knows no operation.
    pub fn projection(&self, wgs84_bounds: Bounds) -> Result<DemProjection, DemError> {
        DemProjection::new(&self.crs, wgs84_bounds)
    }

    /// Length in this CRS over true length (the geometric mean along x and y) at each of `points_m`; `None` where the
    /// CRS ends.
    ///
    /// # Errors
    /// When PROJ knows no operation.
    pub fn scales(&self, points_m: &[[f64; 2]]) -> Result<Vec<Option<f64>>, DemError> {
        let wgs84_from_crs = Operation::new(&self.crs, &Crs::wgs84()?, None);
        let scales = scale::scales(&wgs84_from_crs, points_m)?;
        Ok(scales.into_iter().map(|scale| scale.map(|scale| scale.mean)).collect())
    }
}

#[cfg(test)]
mod tests {
    use corniche_geom::Projection as _;

    use super::*;

    #[test]
    fn a_code_and_its_wkt_are_one_system() {
        let by_code = RecordedCrs::new("EPSG:32632").unwrap();
        let by_wkt = RecordedCrs::new(&by_code.crs.wkt).unwrap();
        assert_eq!((by_wkt.label(), &by_wkt.crs.wkt), ("EPSG:32632", &by_code.crs.wkt));
        let area = Bounds { min_x: 9.0, min_y: 47.0, max_x: 10.0, max_y: 48.0 };
        let mut points = [[[9.5, 47.1]], [[9.5, 47.1]]];
        for (crs, point) in [by_code, by_wkt].iter().zip(&mut points) {
            crs.projection(area).unwrap().working_from_wgs84(point).unwrap();
        }
        assert_eq!(points[0][0].map(f64::to_bits), points[1][0].map(f64::to_bits));
    }

    #[test]
    fn text_that_is_no_crs_is_refused() {
        assert!(RecordedCrs::new("PROJCRS[").is_err());
    }
}
