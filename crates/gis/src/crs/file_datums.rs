//! How positions of files beside the elevation data come to another datum, and which of these ways
//! a build must be allowed to take.

use std::path::{Path, PathBuf};

use corniche_geom::Bounds;
use gdal::spatial_ref::SpatialRef;

use crate::CrsError;
use crate::crs::datum_operation::DatumOperation;
use crate::crs::horizontal::{Crs, GridCrs};
use crate::crs::operation::CrsOperation;

/// Systems, each once, with all that is in them: of thousands of files nearly all have the same
/// one, and asking PROJ takes long.
#[must_use]
pub fn by_system<'a, T>(files: impl Iterator<Item = (&'a Crs, T)>) -> Vec<(&'a Crs, Vec<T>)> {
    let mut systems: Vec<(&Crs, Vec<T>)> = Vec::new();
    for (crs, file) in files {
        match systems.iter_mut().find(|(known, _)| known.wkt == crs.wkt) {
            Some((_, own)) => own.push(file),
            None => systems.push((crs, vec![file])),
        }
    }
    systems
}

/// How positions of files beside the elevation data come to another datum: of photos, polygons, and
/// lines of people's own files.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FileDatums {
    /// Each operation, and the first file that needs it.
    found: Vec<(PathBuf, DatumOperation)>,
}

impl FileDatums {
    /// The operations of files; `operation` says where their positions go, and `places_deg` where
    /// they lie.
    fn of<'a>(
        files: impl Iterator<Item = (&'a Crs, &'a Path)>,
        operation: impl Fn(&Crs) -> CrsOperation,
        places_deg: &[[f64; 2]],
    ) -> Self {
        let mut found = Vec::new();
        for (crs, paths) in by_system(files) {
            let operation = operation(crs);
            if crs.is_same(&operation.to) {
                continue;
            }
            let used = DatumOperation::used(&operation, places_deg);
            let path = paths.first().map(|path| path.to_path_buf()).unwrap_or_default();
            found.extend(used.into_iter().map(|used| (path.clone(), used)));
        }
        Self { found }
    }

    /// The operations of files that come to working metres, for data that lie in `area_deg`.
    pub fn into_working<'a>(
        files: impl Iterator<Item = (&'a Crs, &'a Path)>,
        working: &GridCrs,
        area_deg: Bounds,
    ) -> Self {
        let operation = |crs: &Crs| CrsOperation::into_working(crs, working, Some(area_deg));
        Self::of(files, operation, &[area_deg.center()])
    }

    /// These, unless one of them takes one datum for another and that is not allowed.
    ///
    /// # Errors
    /// [`CrsError::Ballpark`] where it is so.
    pub fn allowed(self, allow_ballpark: bool) -> Result<Self, CrsError> {
        match self.found.iter().find(|(_, found)| found.must_be_allowed) {
            Some((path, refused)) if !allow_ballpark => {
                Err(refused.refusal(path.display().to_string()))
            }
            _ => Ok(self),
        }
    }

    /// What a user should know of them: that another operation is better, or that nobody knows how
    /// good one is.
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

/// The way from a coordinate system, such as that of a layer of a vector file, to longitudes and
/// latitudes of WGS84.
#[derive(Debug, Clone)]
pub struct ToWgs84 {
    operation: CrsOperation,
}

impl ToWgs84 {
    /// The way from a system.
    ///
    /// # Errors
    /// When the system cannot be written down as WKT.
    pub fn new(from: &SpatialRef) -> Result<Self, CrsError> {
        let operation = CrsOperation::new(&Crs::from_spatial_ref(from)?, &Crs::wgs84()?, None);
        Ok(Self { operation })
    }

    /// Replaces positions by their longitudes and latitudes; NaN where there are none.
    ///
    /// # Errors
    /// When PROJ knows no way.
    pub fn apply(&self, points: &mut [[f64; 2]]) -> Result<(), CrsError> {
        self.operation.apply(points)
    }

    /// How positions of a file in this system, which lie at these places, come to the datum of
    /// WGS84.
    #[must_use]
    pub fn datums(&self, path: &Path, places_deg: &[[f64; 2]]) -> FileDatums {
        let file = std::iter::once((&self.operation.from, path));
        FileDatums::of(file, |_| self.operation.clone(), places_deg)
    }
}
