//! The working CRS of a package, created from the package's record without its elevation files, and
//! the projection to it.

use corniche_geom::{Bounds, ProjectError, Projection, Seam};

use crate::crs::datum_operation::DatumOperation;
use crate::crs::horizontal::{Crs, GridCrs};
use crate::crs::operation::CrsOperation;
use crate::crs::{crs_text, scale};
use crate::{CrsError, library_error};

/// The working CRS of a package, from the package's record, without the elevation files.
#[derive(Debug, Clone)]
pub struct RecordedCrs {
    working: GridCrs,
}

impl RecordedCrs {
    /// The CRS of a WKT or a code such as "EPSG:32632", the working metres per unit of its
    /// coordinates, and the rectangle of the data in working metres.
    ///
    /// # Errors
    /// When PROJ cannot read the CRS, or it is neither projected nor geographic.
    pub fn new(text: &str, metres_per_unit: [f64; 2], data: Bounds) -> Result<Self, CrsError> {
        let crs = crs_text::crs_from_text("the package's", text)?.0;
        let is_unit = |factor: f64| factor.abs().to_bits() == crs.unit_m.to_bits();
        let is_scaled = !(crs.is_projected() && metres_per_unit.into_iter().all(is_unit));
        let working = GridCrs { crs, metres_per_unit, middle: 0.0, is_scaled }.around(data);
        Ok(Self { working })
    }

    /// The CRS with the factors to working metres.
    #[must_use]
    pub fn working(&self) -> &GridCrs {
        &self.working
    }

    /// "EPSG:…" if the CRS has a code, else its name.
    #[must_use]
    pub fn label(&self) -> &str {
        &self.working.crs.label
    }

    /// The WKT2, without heights.
    #[must_use]
    pub fn wkt(&self) -> &str {
        &self.working.crs.wkt
    }

    /// WGS84 ⇄ working metres over a rectangle in degrees: the same positions, to the last bit, as
    /// when the package was built with the same rectangle.
    ///
    /// # Errors
    /// When PROJ knows no operation.
    pub fn projection(&self, wgs84_bounds: Bounds) -> Result<DemProjection, CrsError> {
        DemProjection::new(&self.working, wgs84_bounds, wgs84_bounds)
    }

    /// Working metres to coordinates of another projected CRS, such as "EPSG:2056", for data within
    /// a rectangle in degrees.
    ///
    /// # Errors
    /// When PROJ does not know the CRS, it is not projected, or PROJ knows no operation.
    pub fn projected(&self, text: &str, wgs84_bounds: Bounds) -> Result<ProjectedCrs, CrsError> {
        library_error::quiet();
        let (crs, _) = crs_text::crs_from_text("--crs", text)?;
        if !crs.is_projected() {
            return Err(CrsError::NotProjected { text: text.to_owned() });
        }
        // Beyond the area of a datum, the operation of this datum is better than a ballpark
        // operation.
        let operation = |area_deg| {
            let found = CrsOperation::out_of_working(&self.working, &crs, area_deg).exactly();
            // PROJ reports at the first use whether it knows the operation.
            found.apply(&mut [[0.0; 2]]).map(|()| found)
        };
        let from_working = operation(Some(wgs84_bounds)).or_else(|_| operation(None))?;
        Ok(ProjectedCrs { crs, from_working })
    }

    /// The operations between the package's datum and that of WGS84, over the rectangle of all
    /// elevation files in working metres and in degrees; empty if the datum is that of WGS84.
    ///
    /// # Errors
    /// When PROJ knows no operation.
    pub fn datum_operations(
        &self,
        data: Bounds,
        wgs84_bounds: Bounds,
    ) -> Result<Vec<DatumOperation>, CrsError> {
        DatumOperation::to_wgs84(&self.working, data, wgs84_bounds)
    }

    /// Working metres per true metre along x and along y at each of `points_m`; `None` where the
    /// CRS ends.
    ///
    /// # Errors
    /// When PROJ knows no operation.
    pub fn scales(
        &self,
        points_m: &[[f64; 2]],
        wgs84_bounds: Bounds,
    ) -> Result<Vec<Option<[f64; 2]>>, CrsError> {
        let back = CrsOperation::out_of_working(&self.working, &Crs::wgs84()?, Some(wgs84_bounds));
        let scales = scale::scales(&back, points_m)?;
        Ok(scales.into_iter().map(|scale| scale.map(|scale| scale.along)).collect())
    }
}

/// A projected CRS other than the package's own, with the operation to it.
#[derive(Debug, Clone)]
pub struct ProjectedCrs {
    crs: Crs,
    from_working: CrsOperation,
}

impl ProjectedCrs {
    /// The WKT2, without heights.
    #[must_use]
    pub fn wkt(&self) -> &str {
        &self.crs.wkt
    }

    /// Replaces positions in working metres by coordinates of this CRS; NaN if there are none.
    ///
    /// # Errors
    /// When PROJ fails.
    pub fn from_working(&self, positions: &mut [[f64; 2]]) -> Result<(), CrsError> {
        self.from_working.apply(positions)
    }
}

/// WGS84 ⇄ a plan's working metres: PROJ, longitude first, combined with the plan's factors.
///
/// It can be sent to any thread; PROJ's own objects are created once per thread, on first use.
#[derive(Debug, Clone)]
pub struct DemProjection {
    working_from_wgs84: CrsOperation,
    wgs84_from_working: CrsOperation,
    seam: Option<Seam>,
}

impl DemProjection {
    /// Operations for data in `area_deg`. Longitudes in the results are those nearest to the middle
    /// of `near_deg`, so that they are continuous over the data.
    ///
    /// # Errors
    /// When PROJ knows no operation.
    pub fn new(working: &GridCrs, area_deg: Bounds, near_deg: Bounds) -> Result<Self, CrsError> {
        let wgs84 = Crs::wgs84()?;
        let projection = Self {
            working_from_wgs84: CrsOperation::into_working(&wgs84, working, Some(area_deg)),
            wgs84_from_working: CrsOperation::out_of_working(working, &wgs84, Some(area_deg))
                .around(Some(Seam::of_degrees().around(near_deg.center()[0]))),
            seam: working.seam_m(),
        };
        // PROJ reports at the first use whether it knows the operation.
        projection.working_from_wgs84.apply(&mut [area_deg.center()])?;
        projection.wgs84_from_working.apply(&mut [[0.0; 2]])?;
        Ok(projection)
    }
}

impl Projection for DemProjection {
    fn working_from_wgs84(&self, points: &mut [[f64; 2]]) -> Result<(), ProjectError> {
        apply(&self.working_from_wgs84, points)
    }

    fn wgs84_from_working(&self, points: &mut [[f64; 2]]) -> Result<(), ProjectError> {
        apply(&self.wgs84_from_working, points)
    }

    fn seam(&self) -> Option<Seam> {
        self.seam
    }
}

fn apply(operation: &CrsOperation, points: &mut [[f64; 2]]) -> Result<(), ProjectError> {
    operation.apply(points).map_err(|error| {
        let cause =
            std::error::Error::source(&error).map(|cause| format!(": {cause}")).unwrap_or_default();
        ProjectError { reason: format!("{error}{cause}") }
    })
}

#[cfg(test)]
#[path = "recorded_tests.rs"]
mod tests;
