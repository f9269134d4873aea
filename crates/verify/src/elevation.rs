//! The elevation files of a package, for callers that compare something with them.

use std::path::PathBuf;

use corniche_dem::{Dem, GridPlan};
use corniche_gis::RegionPolygons;
use corniche_spec::{
    BuildObserver,
    inputs::{InputFiles, OtherInputs},
};
use corniche_tileset::FilePackage;

use super::{
    checks::Check, dem_inputs, error::VerifyError, polygon, verify_settings::VerifySettings,
};

/// The elevation files from which a package was built, opened as its build did.
#[derive(Debug)]
pub struct RecordedElevation {
    /// The files.
    pub dem: Dem,
    /// The package's grid.
    pub plan: GridPlan,
    inputs: InputFiles,
}

impl RecordedElevation {
    /// Opens the files, and checks that they are those of the build. `polygon` is the polygon to
    /// which the package was clipped, if any.
    ///
    /// # Errors
    /// When a file cannot be read, or the files are not those of the build.
    pub fn open(
        package: &FilePackage,
        files: &[PathBuf],
        polygon: Option<RegionPolygons>,
        observer: &dyn BuildObserver,
    ) -> Result<Self, VerifyError> {
        polygon::check(package.manifest(), polygon.as_ref())?;
        let inputs = InputFiles::find(files, OtherInputs::default())?;
        let settings = VerifySettings {
            dem: files.to_vec(),
            photo: Vec::new(),
            osm: None,
            polygon,
            threads: 1,
        };
        let mut checks = Vec::new();
        let manifest = package.manifest();
        let opened = dem_inputs::open(&settings, &inputs, manifest, &mut checks, observer)?;
        match opened {
            Some((dem, plan)) if checks.iter().all(Check::holds) => Ok(Self { dem, plan, inputs }),
            _ => Err(VerifyError::OtherGrid),
        }
    }

    /// Checks that no file has changed since it was opened. Call it when everything is read.
    ///
    /// # Errors
    /// When a file has changed.
    pub fn check_unchanged(&self) -> Result<(), VerifyError> {
        Ok(self.inputs.check_unchanged()?)
    }
}
