//! The given input files, checked to be those of the build before the long work begins.

use std::path::PathBuf;

use corniche_dem::{Dem, GridPlan};
use corniche_spec::{
    BuildObserver,
    inputs::{InputFiles, OtherInputs},
};
use corniche_tileset::Manifest;

use super::{
    checks::{Check, Findings},
    dem_inputs,
    error::{Result, VerifyError},
    osm, photo_files,
    verify_settings::{GivenFiles, VerifySettings},
};

/// The given inputs in addition to the package.
pub(crate) struct GivenInputs {
    /// The elevation files, opened as by the build; the inner `None` means that their grid is not
    /// the package's.
    pub dem: Option<GivenFiles<Option<(Dem, GridPlan)>>>,
    pub photo: Option<GivenFiles<()>>,
    /// The extracts, in the order in which the build read them.
    pub osm: Option<GivenFiles<Vec<PathBuf>>>,
    /// The findings about the files.
    pub findings: Findings,
}

impl GivenInputs {
    /// Fails if one of the files, or a table, is not that of the build.
    pub(crate) fn open(
        manifest: &Manifest,
        settings: &VerifySettings,
        observer: &dyn BuildObserver,
    ) -> Result<Self> {
        let mut findings = Findings::default();
        let mut checks: Vec<Check> = Vec::new();
        let dem = (!settings.dem.is_empty()).then(|| {
            looked_at(InputFiles::find(&settings.dem, OtherInputs::default())?, |inputs| {
                dem_inputs::open(settings, inputs, manifest, &mut checks, observer)
            })
        });
        let dem = dem.transpose()?;
        findings.merge(checks);
        let photo = (!settings.photo.is_empty()).then(|| {
            let others = OtherInputs { photo: &settings.photo, ..OtherInputs::default() };
            looked_at(InputFiles::find(&[], others)?, |inputs| {
                let given = inputs.hash(observer)?;
                photo_files::check_inputs(manifest, &settings.photo, &given, &mut findings)
            })
        });
        let photo = photo.transpose()?;
        let osm = settings.osm.as_ref().map(|asked| {
            let others = OtherInputs { osm: &asked.paths, ..OtherInputs::default() };
            looked_at(InputFiles::find(&[], others)?, |inputs| {
                osm::check_inputs(manifest, asked, inputs, &mut findings, observer)
            })
        });
        let osm = osm.transpose()?;
        Ok(Self { dem, photo, osm, findings })
    }
}

fn looked_at<T>(
    inputs: InputFiles,
    look: impl FnOnce(&InputFiles) -> Result<T>,
) -> Result<GivenFiles<T>> {
    let found = look(&inputs);
    let found = VerifyError::unless_changed(&inputs, found)?;
    Ok(GivenFiles { inputs, found })
}
