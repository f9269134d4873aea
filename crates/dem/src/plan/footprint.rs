//! Where files have samples, grid by grid.

use crate::crs::operation::Operation;
use crate::mosaics::mosaic::Mosaic;
use crate::{Dem, DemError, GridPlan};

/// The samples of the files that lie on one grid.
pub struct Footprint<'a> {
    /// For each file its first and its last sample: column, row. On a grid all around the earth, one more column closes it.
    pub rects: Vec<[[i64; 2]; 2]>,
    mosaic: &'a Mosaic,
    working_from_crs: &'a Operation,
}

impl Dem {
    /// Where its files have samples. Those of several grids may overlap.
    #[must_use]
    pub fn footprints<'a>(&'a self, plan: &'a GridPlan) -> Vec<Footprint<'a>> {
        let of_mosaic = |mosaic: &'a Mosaic| {
            let rects = mosaic.files.iter().map(|file| {
                let closed = mosaic.closed(&file.rect);
                [closed.min, closed.max.map(|end| end - 1)]
            });
            rects.collect()
        };
        let all = self.mosaics.iter().zip(&plan.roles);
        all.map(|(mosaic, role)| Footprint {
            rects: of_mosaic(mosaic),
            mosaic,
            working_from_crs: &role.working_from_crs,
        })
        .collect()
    }
}

impl Footprint<'_> {
    /// Carries places among the samples (column, row) to working metres; those without a place there become NaN.
    ///
    /// # Errors
    /// When PROJ fails.
    pub fn to_working_m(&self, places: &mut [[f64; 2]]) -> Result<(), DemError> {
        for place in &mut *places {
            *place = self.mosaic.crs_from_sample.crs_from_pixel(*place);
        }
        self.working_from_crs.apply(places)
    }
}
