//! The working CRS of a package, made from what the package records and without its elevation files.

use corniche_geom::Bounds;

use crate::crs::datum_operation::DatumOperation;
use crate::crs::horizontal::Crs;
use crate::crs::operation::Operation;
use crate::crs::working::Working;
use crate::crs::{compound, datum_operation, scale};
use crate::{DemError, DemProjection, library_error};

/// The working CRS of a package, from what the package records of it: without the elevation files.
#[derive(Debug, Clone)]
pub struct RecordedCrs {
    working: Working,
}

impl RecordedCrs {
    /// The CRS of a WKT or a code such as "EPSG:32632", the working metres to a unit of its coordinates, and the rectangle of
    /// the data in working metres.
    ///
    /// # Errors
    /// When PROJ cannot read it, or it is neither projected nor geographic.
    pub fn new(text: &str, metres_per_unit: [f64; 2], data: Bounds) -> Result<Self, DemError> {
        let crs = compound::from_text("the package's", text)?.0;
        let is_unit = |factor: f64| factor.abs().to_bits() == crs.unit_m.to_bits();
        let is_scaled = !(crs.is_projected() && metres_per_unit.into_iter().all(is_unit));
        let working = Working { crs, metres_per_unit, middle: 0.0, is_scaled }.around(data);
        Ok(Self { working })
    }

    pub(crate) fn working(&self) -> &Working {
        &self.working
    }

    /// "EPSG:…" where it has a code, else its name.
    #[must_use]
    pub fn label(&self) -> &str {
        &self.working.crs.label
    }

    /// Its WKT2, without heights.
    #[must_use]
    pub fn wkt(&self) -> &str {
        &self.working.crs.wkt
    }

    /// WGS84 ⇄ working metres over a rectangle in degrees: the same positions, to the last bit, as when the package was
    /// built with the same rectangle.
    ///
    /// # Errors
    /// When PROJ knows no operation.
    pub fn projection(&self, wgs84_bounds: Bounds) -> Result<DemProjection, DemError> {
        DemProjection::new(&self.working, wgs84_bounds, wgs84_bounds)
    }

    /// Working metres to coordinates of another projected CRS, such as "EPSG:2056", for data within a rectangle in degrees.
    ///
    /// # Errors
    /// When PROJ does not know it, it is not projected, or PROJ knows no operation.
    pub fn projected(&self, text: &str, wgs84_bounds: Bounds) -> Result<ProjectedCrs, DemError> {
        library_error::quiet();
        let (crs, _) = compound::from_text("--crs", text)?;
        if !crs.is_projected() {
            return Err(DemError::NotProjected { text: text.to_owned() });
        }
        // Beyond the area for which a datum was made, its operation is better than to take it for another one.
        let operation = |area_deg| {
            let found = Operation::out_of_working(&self.working, &crs, area_deg).exactly();
            // PROJ reports at the first use whether it knows the operation.
            found.apply(&mut [[0.0; 2]]).map(|()| found)
        };
        let from_working = operation(Some(wgs84_bounds)).or_else(|_| operation(None))?;
        Ok(ProjectedCrs { crs, from_working })
    }

    /// The operations that carry positions between the package's datum and that of WGS84, over the rectangle of all elevation files in
    /// working metres and in degrees; none where the datum is that of WGS84.
    ///
    /// # Errors
    /// When PROJ knows no operation.
    pub fn datum_operations(
        &self,
        data: Bounds,
        wgs84_bounds: Bounds,
    ) -> Result<Vec<DatumOperation>, DemError> {
        datum_operation::to_wgs84(&self.working, data, wgs84_bounds)
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

/// A projected CRS other than the package's own, and the way there.
#[derive(Debug, Clone)]
pub struct ProjectedCrs {
    crs: Crs,
    from_working: Operation,
}

impl ProjectedCrs {
    /// Its WKT2, without heights.
    #[must_use]
    pub fn wkt(&self) -> &str {
        &self.crs.wkt
    }

    /// Replaces positions in working metres by its coordinates; NaN where there are none.
    ///
    /// # Errors
    /// When PROJ fails.
    pub fn from_working(&self, positions: &mut [[f64; 2]]) -> Result<(), DemError> {
        self.from_working.apply(positions)
    }
}

#[cfg(test)]
#[path = "recorded_tests.rs"]
mod tests;
