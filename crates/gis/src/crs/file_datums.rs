//! The datum operations of input files other than elevation data, and the check whether a build may
//! use them.

use std::path::{Path, PathBuf};

use corniche_geom::Bounds;
use gdal::spatial_ref::SpatialRef;

use crate::CrsError;
use crate::crs::datum_operation::DatumOperation;
use crate::crs::horizontal::{Crs, GridCrs};
use crate::crs::operation::CrsOperation;

/// Groups items by system, so that each system occurs once: thousands of files nearly always share
/// one system, and queries to PROJ are slow.
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

/// The datum operations of input files other than elevation data: photos, polygons, and the user's
/// lines.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FileDatums {
    /// Each operation, with the first file that needs it.
    found: Vec<(PathBuf, DatumOperation)>,
}

impl FileDatums {
    /// The operations of files; `operation` returns the one from a system, and `places_deg` are
    /// positions in the files.
    fn from_files<'a>(
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

    /// The operations from files to working metres, for data in `area_deg`.
    pub fn into_working<'a>(
        files: impl Iterator<Item = (&'a Crs, &'a Path)>,
        working: &GridCrs,
        area_deg: Bounds,
    ) -> Self {
        let operation = |crs: &Crs| CrsOperation::into_working(crs, working, Some(area_deg));
        Self::from_files(files, operation, &[area_deg.center()])
    }

    /// Returns the operations, unless one of them is a ballpark operation between datums and this
    /// is not allowed.
    ///
    /// # Errors
    /// [`CrsError::Ballpark`] for such an operation.
    pub fn allowed(self, allow_ballpark: bool) -> Result<Self, CrsError> {
        match self.found.iter().find(|(_, found)| found.must_be_allowed) {
            Some((path, refused)) if !allow_ballpark => Err(refused.refusal(format!("{path:?}"))),
            _ => Ok(self),
        }
    }

    /// Warnings for the user: a better operation exists, or the accuracy is unknown.
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        let warning = |(path, found): &(PathBuf, DatumOperation)| {
            found.warning().map(|text| format!("{path:?}: {text}"))
        };
        self.found.iter().filter_map(warning)
    }

    /// Adds the operations of other files.
    pub fn extend(&mut self, others: Self) {
        self.found.extend(others.found);
    }
}

/// The operation from a coordinate system, such as that of a layer of a vector file, to longitudes
/// and latitudes of WGS84.
#[derive(Debug, Clone)]
pub struct ToWgs84 {
    operation: CrsOperation,
}

impl ToWgs84 {
    /// The operation from a system.
    ///
    /// # Errors
    /// When the system cannot be written as WKT.
    pub fn new(from: &SpatialRef) -> Result<Self, CrsError> {
        let operation = CrsOperation::new(&Crs::from_spatial_ref(from)?, &Crs::wgs84()?, None);
        Ok(Self { operation })
    }

    /// Replaces positions by their longitudes and latitudes; NaN if there are none.
    ///
    /// # Errors
    /// When PROJ knows no operation.
    pub fn apply(&self, points: &mut [[f64; 2]]) -> Result<(), CrsError> {
        self.operation.apply(points)
    }

    /// The datum operations from a file in this system, with these positions, to WGS84.
    #[must_use]
    pub fn datums(&self, path: &Path, places_deg: &[[f64; 2]]) -> FileDatums {
        let file = std::iter::once((&self.operation.from, path));
        FileDatums::from_files(file, |_| self.operation.clone(), places_deg)
    }
}
