//! How positions of all files and of the roads come to the datum of a package, and which of these ways a build must be allowed to take.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use corniche_geom::Bounds;

use crate::crs::datum_operation::{self, DatumOperation};
use crate::crs::horizontal::Crs;
use crate::crs::operation::Operation;
use crate::crs::working::Working;
use crate::mosaics::data_extent;
use crate::{Dem, DemError, GridPlan, Polygon};

/// Operations between the datum of each file, that of the working CRS and WGS84, each once; `data` is the rectangle of all nodes,
/// `into_working` has an operation for each mosaic. PROJ is asked once for each system. None where all datums are that of WGS84.
pub(crate) fn datum_operations(
    dem: &Dem,
    working: &Working,
    data: Bounds,
    into_working: &[Operation],
) -> Result<Vec<DatumOperation>, DemError> {
    let mut all = datum_operation::to_wgs84(working, data, dem.wgs84_bounds)?;
    // Of thousands of mosaics nearly all have the same system, and asking PROJ takes long.
    let mut asked: Vec<(&Operation, Vec<[f64; 2]>)> = Vec::new();
    for (mosaic, operation) in dem.mosaics.iter().zip(into_working) {
        if mosaic.crs.is_same(&working.crs) {
            continue;
        }
        let known = asked.iter().position(|(known, _)| known.from.wkt == operation.from.wkt);
        let at = known.unwrap_or_else(|| {
            asked.push((operation, Vec::new()));
            asked.len() - 1
        });
        let places = &mut asked[at].1;
        places.push(mosaic.middle());
        places.extend(data_extent::positions(mosaic, &mosaic.extent));
    }
    let wgs84 = Crs::wgs84()?;
    for (operation, mut places) in asked {
        let to_degrees = Operation::new(&operation.from, &wgs84, Some(dem.wgs84_bounds));
        to_degrees.apply(&mut places)?;
        for found in datum_operation::used(operation, &places) {
            if !all.contains(&found) {
                all.push(found);
            }
        }
    }
    Ok(all)
}

impl Dem {
    /// Refuses a plan for which one datum is taken for another, because PROJ knows nothing between them: roads would lie 100 m and more
    /// beside the ground. Datums on the ellipsoid of WGS84 are not refused.
    ///
    /// # Errors
    /// [`DemError::Ballpark`] where it is so.
    pub fn refuse_ballpark(&self, plan: &GridPlan) -> Result<(), DemError> {
        let Some(refused) = plan.datum_operations.iter().find(|found| found.must_be_allowed) else {
            return Ok(());
        };
        let has_it = |label: &str| {
            let mosaic = self.mosaics.iter().find(|mosaic| mosaic.crs.label == label)?;
            mosaic.files.first().map(|file| self.sources[file.index].path.clone())
        };
        let path: Option<PathBuf> = has_it(&refused.from).or_else(|| has_it(&refused.to));
        Err(refused
            .refusal(path.map_or_else(|| "--crs".to_owned(), |path| path.display().to_string())))
    }
}

impl GridPlan {
    /// Refuses a polygon whose datum would be taken for that of the grid; see [`Dem::refuse_ballpark`].
    ///
    /// # Errors
    /// [`DemError::Ballpark`] where it is so.
    pub fn refuse_ballpark_of_polygon(&self, polygon: &Polygon) -> Result<(), DemError> {
        self.refuse_ballpark_of(polygon.parts().iter().map(|part| (polygon.path(), &part.crs)))
    }

    /// Refuses files whose datum would be taken for that of the grid.
    pub(crate) fn refuse_ballpark_of<'a>(
        &self,
        files: impl Iterator<Item = (&'a Path, &'a Crs)>,
    ) -> Result<(), DemError> {
        let area_deg = self.area_deg();
        let mut seen: BTreeSet<&str> = BTreeSet::new();
        for (path, crs) in files {
            // Of thousands of files nearly all have the same system.
            if !seen.insert(&crs.wkt) || crs.is_same(&self.working.crs) {
                continue;
            }
            let operation = Operation::into_working(crs, &self.working, Some(area_deg));
            let found = datum_operation::used(&operation, &[area_deg.center()]);
            if let Some(refused) = found.into_iter().find(|found| found.must_be_allowed) {
                return Err(refused.refusal(path.display().to_string()));
            }
        }
        Ok(())
    }
}
