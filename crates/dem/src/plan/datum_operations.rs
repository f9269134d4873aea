//! How positions of all files and of the roads come to the datum of a package, and which of these ways a build must be allowed to take.

use std::path::{Path, PathBuf};

use corniche_geom::Bounds;
use gdal::spatial_ref::SpatialRef;

use crate::crs::datum_operation::{self, DatumOperation};
use crate::crs::horizontal::Crs;
use crate::crs::operation::Operation;
use crate::crs::working::Working;
use crate::mosaics::data_extent;
use crate::{Dem, DemError, GridPlan, Polygon};

/// Operations between the datum of each file, that of the working CRS and WGS84, each once; `data` is the rectangle of all nodes. None
/// where all datums are that of WGS84.
pub(crate) fn datum_operations(
    dem: &Dem,
    working: &Working,
    data: Bounds,
) -> Result<Vec<DatumOperation>, DemError> {
    let area_deg = Some(dem.wgs84_bounds);
    let mut all = datum_operation::to_wgs84(working, data, dem.wgs84_bounds)?;
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
        Operation::new(crs, &wgs84, area_deg).apply(&mut places)?;
        let operation = Operation::into_working(crs, working, area_deg);
        for found in datum_operation::used(&operation, &places) {
            if !all.contains(&found) {
                all.push(found);
            }
        }
    }
    Ok(all)
}

/// Systems, each once, with all that is in them: of thousands of files nearly all have the same one, and asking PROJ takes long.
fn by_system<'a, T>(files: impl Iterator<Item = (&'a Crs, T)>) -> Vec<(&'a Crs, Vec<T>)> {
    let mut systems: Vec<(&Crs, Vec<T>)> = Vec::new();
    for (crs, file) in files {
        match systems.iter_mut().find(|(known, _)| known.wkt == crs.wkt) {
            Some((_, own)) => own.push(file),
            None => systems.push((crs, vec![file])),
        }
    }
    systems
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

/// How positions of files beside the elevation data come to another datum: of photos, polygons, and lines of people's own files.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FileDatums {
    /// Each operation, and the first file that needs it.
    found: Vec<(PathBuf, DatumOperation)>,
}

impl FileDatums {
    /// The operations of files; `operation` says where their positions go, and `places_deg` where they lie.
    fn of<'a>(
        files: impl Iterator<Item = (&'a Crs, &'a Path)>,
        operation: impl Fn(&Crs) -> Operation,
        places_deg: &[[f64; 2]],
    ) -> Self {
        let mut found = Vec::new();
        for (crs, paths) in by_system(files) {
            let operation = operation(crs);
            if crs.is_same(&operation.to) {
                continue;
            }
            let used = datum_operation::used(&operation, places_deg);
            let path = paths.first().map(|path| path.to_path_buf()).unwrap_or_default();
            found.extend(used.into_iter().map(|used| (path.clone(), used)));
        }
        Self { found }
    }

    /// These, unless one of them takes one datum for another and that is not allowed; see [`Dem::refuse_ballpark`].
    ///
    /// # Errors
    /// [`DemError::Ballpark`] where it is so.
    pub fn allowed(self, allow_ballpark: bool) -> Result<Self, DemError> {
        match self.found.iter().find(|(_, found)| found.must_be_allowed) {
            Some((path, refused)) if !allow_ballpark => {
                Err(refused.refusal(path.display().to_string()))
            }
            _ => Ok(self),
        }
    }

    /// What a user should know of them: that another operation is better, or that nobody knows how good one is.
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        let warning = |(path, found): &(PathBuf, DatumOperation)| {
            found.warning().map(|text| format!("{}: {text}", path.display()))
        };
        self.found.iter().filter_map(warning)
    }

    /// Adds those of other files.
    pub fn extend(&mut self, others: Self) {
        self.found.extend(others.found);
    }
}

impl GridPlan {
    /// How a polygon comes to the datum of the grid.
    #[must_use]
    pub fn datums_of_polygon(&self, polygon: &Polygon) -> FileDatums {
        self.datums_of(polygon.parts().iter().map(|part| (&part.crs, polygon.path())))
    }

    /// How files come to the datum of the grid.
    pub(crate) fn datums_of<'a>(
        &self,
        files: impl Iterator<Item = (&'a Crs, &'a Path)>,
    ) -> FileDatums {
        let area_deg = self.area_deg();
        let operation = |crs: &Crs| Operation::into_working(crs, &self.working, Some(area_deg));
        FileDatums::of(files, operation, &[area_deg.center()])
    }
}

/// The way from a coordinate system, such as that of a layer of a vector file, to longitudes and latitudes of WGS84.
#[derive(Debug, Clone)]
pub struct ToWgs84 {
    operation: Operation,
}

impl ToWgs84 {
    /// The way from a system.
    ///
    /// # Errors
    /// When the system cannot be written down as WKT.
    pub fn new(from: &SpatialRef) -> Result<Self, DemError> {
        let operation = Operation::new(&Crs::from_spatial_ref(from)?, &Crs::wgs84()?, None);
        Ok(Self { operation })
    }

    /// Replaces positions by their longitudes and latitudes; NaN where there are none.
    ///
    /// # Errors
    /// When PROJ knows no way.
    pub fn apply(&self, points: &mut [[f64; 2]]) -> Result<(), DemError> {
        self.operation.apply(points)
    }

    /// How positions of a file in this system, which lie at these places, come to the datum of WGS84.
    #[must_use]
    pub fn datums(&self, path: &Path, places_deg: &[[f64; 2]]) -> FileDatums {
        let file = std::iter::once((&self.operation.from, path));
        FileDatums::of(file, |_| self.operation.clone(), places_deg)
    }
}
