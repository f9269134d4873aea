//! The elevation files of a package, for who compares with them.

use std::path::PathBuf;

use corniche_dem::{Dem, GridPlan};
use corniche_gis::Polygon;
use corniche_spec::{
    Observer,
    inputs::{Inputs, OtherInputs},
};
use corniche_tileset::FilePackage;

use super::{
    checks::Check, dem_inputs, error::VerifyError, polygon, verify_settings::VerifySettings,
};

/// The elevation files that a package was made from, opened as its build did.
#[derive(Debug)]
pub struct RecordedElevation {
    /// The files.
    pub dem: Dem,
    /// The package's grid.
    pub plan: GridPlan,
    inputs: Inputs,
}

impl RecordedElevation {
    /// Opens the files and makes sure that they are those of the build. `polygon` is the one that the package was cut with, if it was.
    ///
    /// # Errors
    /// When a file cannot be read, or they are not those of the build.
    pub fn open(
        package: &FilePackage,
        files: &[PathBuf],
        polygon: Option<Polygon>,
        observer: &dyn Observer,
    ) -> Result<Self, VerifyError> {
        polygon::check(package.manifest(), polygon.as_ref())?;
        let inputs = Inputs::find(files, OtherInputs::default())?;
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

    /// Makes sure that no file changed since it was opened: to be asked when all is read.
    ///
    /// # Errors
    /// When one did.
    pub fn check_unchanged(&self) -> Result<(), VerifyError> {
        Ok(self.inputs.check_unchanged()?)
    }
}
