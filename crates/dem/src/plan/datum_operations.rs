//! The datum operations for all files and for the roads, and the check whether a build may use
//! them.

use std::path::PathBuf;

use corniche_geom::Bounds;
use corniche_gis::{
    Crs, CrsError, CrsOperation, DatumOperation, FileDatums, GridCrs, PlacedRaster, RegionPolygons,
    by_system,
};

use crate::mosaics::data_extent;
use crate::{Dem, GridPlan};

/// Operations between the datum of each file, that of the working CRS and WGS84, each once; `data`
/// is the rectangle of all nodes. Empty if all datums are that of WGS84.
pub(crate) fn datum_operations(
    dem: &Dem,
    working: &GridCrs,
    data: Bounds,
) -> Result<Vec<DatumOperation>, CrsError> {
    let area_deg = Some(dem.wgs84_bounds);
    let mut all = DatumOperation::to_wgs84(working, data, dem.wgs84_bounds)?;
    let wgs84 = Crs::wgs84()?;
    for (crs, mosaics) in by_system(dem.mosaics.iter().map(|mosaic| (&mosaic.crs, mosaic))) {
        if crs.is_same(&working.crs) {
            continue;
        }
        let mut places = Vec::new();
        for mosaic in mosaics {
            places.push(mosaic.middle());
            places.extend(data_extent::positions(mosaic, &mosaic.extent));
        }
        CrsOperation::new(crs, &wgs84, area_deg).apply(&mut places)?;
        let operation = CrsOperation::into_working(crs, working, area_deg);
        for found in DatumOperation::used(&operation, &places) {
            if !all.contains(&found) {
                all.push(found);
            }
        }
    }
    Ok(all)
}

impl Dem {
    /// Rejects a plan that treats one datum as another, because PROJ knows no transformation
    /// between them: roads would be 100 m or more off the ground. Datums on the ellipsoid of WGS84
    /// are accepted.
    ///
    /// # Errors
    /// [`CrsError::Ballpark`] for such a plan.
    pub fn refuse_ballpark(&self, plan: &GridPlan) -> Result<(), CrsError> {
        let Some(refused) = plan.datum_operations.iter().find(|found| found.must_be_allowed) else {
            return Ok(());
        };
        let has_it = |label: &str| {
            let mosaic = self.mosaics.iter().find(|mosaic| mosaic.crs.label == label)?;
            mosaic.files.first().map(|file| self.sources[file.index].path.clone())
        };
        let path: Option<PathBuf> =
            has_it(&refused.record.from).or_else(|| has_it(&refused.record.to));
        Err(refused.refusal(path.map_or_else(|| "--crs".to_owned(), |path| format!("{path:?}"))))
    }
}

impl GridPlan {
    /// The datum operations from rasters, such as photos, to the grid.
    pub fn datums_of_rasters<'a>(
        &self,
        rasters: impl Iterator<Item = &'a PlacedRaster>,
    ) -> FileDatums {
        let files = rasters.map(|raster| (raster.crs(), raster.path()));
        FileDatums::into_working(files, &self.working, self.area_deg())
    }

    /// The datum operations from a polygon to the grid.
    #[must_use]
    pub fn datums_of_polygon(&self, polygon: &RegionPolygons) -> FileDatums {
        let files = polygon.systems().map(|crs| (crs, polygon.path()));
        FileDatums::into_working(files, &self.working, self.area_deg())
    }
}
