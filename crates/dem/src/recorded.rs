use corniche_geom::Bounds;

use crate::crs::Crs;
use crate::operation::Operation;
use crate::working::Working;
use crate::{DemError, DemProjection, scale};

/// The working CRS of a package, from what the package records of it: without the elevation files.
#[derive(Debug, Clone)]
pub struct RecordedCrs {
    working: Working,
}

impl RecordedCrs {
    /// From its WKT or a code such as "EPSG:32632", the working metres to a unit of its coordinates, and the rectangle of
    /// the data in working metres.
    ///
    /// # Errors
    /// When PROJ cannot read it, or it is neither projected nor geographic.
    pub fn new(text: &str, metres_per_unit: [f64; 2], data: Bounds) -> Result<Self, DemError> {
        let crs = Crs::from_text("the package's", text)?.0;
        let middle = data.center()[0] / metres_per_unit[0];
        let is_unit = |factor: f64| factor.abs().to_bits() == crs.unit_m.to_bits();
        let is_scaled = !(crs.is_projected() && metres_per_unit.into_iter().all(is_unit));
        Ok(Self { working: Working { crs, metres_per_unit, middle, is_scaled } })
    }

    /// "EPSG:…" where it has a code, else its name.
    #[must_use]
    pub fn label(&self) -> &str {
        &self.working.crs.label
    }

    /// WGS84 ⇄ working metres over a rectangle in degrees: the same positions, to the last bit, as when the package was
    /// built with the same rectangle.
    ///
    /// # Errors
    /// When PROJ knows no operation.
    pub fn projection(&self, wgs84_bounds: Bounds) -> Result<DemProjection, DemError> {
        DemProjection::new(&self.working, wgs84_bounds)
    }

    /// Working metres to a true metre along x and along y at each of `points_m`; `None` where the CRS ends.
    ///
    /// # Errors
    /// When PROJ knows no operation.
    pub fn scales(
        &self,
        points_m: &[[f64; 2]],
        wgs84_bounds: Bounds,
    ) -> Result<Vec<Option<[f64; 2]>>, DemError> {
        let back = Operation::out_of_working(&self.working, &Crs::wgs84()?, Some(wgs84_bounds));
        let scales = scale::scales(&back, points_m)?;
        Ok(scales.into_iter().map(|scale| scale.map(|scale| scale.along)).collect())
    }
}

#[cfg(test)]
mod tests {
    use corniche_geom::Projection as _;

    use super::*;

    #[test]
    fn a_code_and_its_wkt_are_one_system() {
        let data =
            Bounds { min_x: 500_000.0, min_y: 5_200_000.0, max_x: 510_000.0, max_y: 5_210_000.0 };
        let by_code = RecordedCrs::new("EPSG:32632", [1.0; 2], data).unwrap();
        let by_wkt = RecordedCrs::new(&by_code.working.crs.wkt, [1.0; 2], data).unwrap();
        assert_eq!(by_wkt.label(), "EPSG:32632");
        let area = Bounds { min_x: 9.0, min_y: 47.0, max_x: 10.0, max_y: 48.0 };
        let mut points = [[[9.5, 47.1]], [[9.5, 47.1]]];
        for (crs, point) in [by_code, by_wkt].iter().zip(&mut points) {
            crs.projection(area).unwrap().working_from_wgs84(point).unwrap();
        }
        assert_eq!(points[0][0].map(f64::to_bits), points[1][0].map(f64::to_bits));
    }

    #[test]
    fn text_that_is_no_crs_is_refused() {
        assert!(RecordedCrs::new("PROJCRS[", [1.0; 2], Bounds::EMPTY).is_err());
    }
}
