//! The projection between WGS84 and the working metres of a grid plan, by PROJ.

use corniche_geom::{Bounds, ProjectError, Projection, Seam};

use crate::DemError;
use crate::crs::horizontal::Crs;
use crate::crs::operation::Operation;
use crate::crs::working::Working;

/// WGS84 ⇄ a plan's working metres: PROJ, longitude first, and the plan's factors around it.
///
/// Goes to any thread; PROJ's own objects are made once per thread, on first use.
#[derive(Debug, Clone)]
pub struct DemProjection {
    working_from_wgs84: Operation,
    wgs84_from_working: Operation,
    seam: Option<Seam>,
}

impl DemProjection {
    /// Operations for data in `area_deg`. Longitudes come out as those that are nearest to the middle of `near_deg`: over the data they are
    /// continuous.
    pub(crate) fn new(
        working: &Working,
        area_deg: Bounds,
        near_deg: Bounds,
    ) -> Result<Self, DemError> {
        let wgs84 = Crs::wgs84()?;
        let projection = Self {
            working_from_wgs84: Operation::into_working(&wgs84, working, Some(area_deg)),
            wgs84_from_working: Operation::out_of_working(working, &wgs84, Some(area_deg))
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

fn apply(operation: &Operation, points: &mut [[f64; 2]]) -> Result<(), ProjectError> {
    operation.apply(points).map_err(|error| {
        let cause =
            std::error::Error::source(&error).map(|cause| format!(": {cause}")).unwrap_or_default();
        ProjectError { reason: format!("{error}{cause}") }
    })
}
