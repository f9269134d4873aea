//! The extents of files, grid by grid, in samples and in nodes.

use corniche_geom::NodeIndex;
use corniche_gis::{CrsError, CrsOperation};

use crate::mosaics::data_extent;
use crate::mosaics::mosaic::Mosaic;
use crate::plan::clip::common;
use crate::plan::grid_plan::Method;
use crate::plan::layout::corner_nodes;
use crate::{Dem, GridPlan};

/// The extents of the files on one grid.
pub struct Footprint<'a> {
    /// For each file its first and its last sample: column, row. On a grid all around the earth,
    /// one more column closes the ring.
    pub rects: Vec<[[i64; 2]; 2]>,
    mosaic: &'a Mosaic,
    working_from_crs: &'a CrsOperation,
}

impl Dem {
    /// For each file, the south-western and the north-eastern node between which it can have data,
    /// within the plan's nodes. Files without a node between their samples are omitted.
    ///
    /// # Errors
    /// When a file's position cannot be transformed.
    pub fn file_nodes(&self, plan: &GridPlan) -> Result<Vec<[NodeIndex; 2]>, CrsError> {
        let mut found = Vec::new();
        for (mosaic, role) in self.mosaics.iter().zip(&plan.roles.0) {
            for file in &mosaic.files {
                let own = match &role.method {
                    Method::Aligned(alignment) => alignment.nodes(&mosaic.closed(&file.rect)),
                    Method::Resampled(..) => {
                        let bounds =
                            data_extent::bounds(mosaic, &file.rect, &role.working_from_crs)?;
                        let (origin_m, cell) = (plan.frame.origin_m(), plan.frame.cell());
                        corner_nodes(bounds, origin_m, cell, [f64::ceil, f64::floor])
                    }
                };
                let [south_west, north_east] = common(own, [plan.south_west, plan.north_east]);
                if south_west.i <= north_east.i && south_west.j <= north_east.j {
                    found.push([south_west, north_east]);
                }
            }
        }
        Ok(found)
    }

    /// The extents of the DEM's files. Those of several grids may overlap.
    #[must_use]
    pub fn footprints<'a>(&'a self, plan: &'a GridPlan) -> Vec<Footprint<'a>> {
        let of_mosaic = |mosaic: &'a Mosaic| {
            let rects = mosaic.files.iter().map(|file| {
                let closed = mosaic.closed(&file.rect);
                [closed.min, closed.max.map(|end| end - 1)]
            });
            rects.collect()
        };
        let all = self.mosaics.iter().zip(&plan.roles.0);
        all.map(|(mosaic, role)| Footprint {
            rects: of_mosaic(mosaic),
            mosaic,
            working_from_crs: &role.working_from_crs,
        })
        .collect()
    }
}

impl Footprint<'_> {
    /// Transforms positions among the samples (column, row) to working metres; positions without an
    /// image become NaN.
    ///
    /// # Errors
    /// When PROJ fails.
    pub fn to_working_m(&self, places: &mut [[f64; 2]]) -> Result<(), CrsError> {
        for place in &mut *places {
            *place = self.mosaic.crs_from_sample.crs_from_pixel(*place);
        }
        self.working_from_crs.apply(places)
    }
}
