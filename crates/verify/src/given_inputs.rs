//! The files that a verification is given: how they are asked for, and found to be those of the build before the long work begins.

use std::path::PathBuf;

use corniche_areas::AreaTable;
use corniche_dem::{Dem, GridPlan};
use corniche_gis::Polygon;
use corniche_roads::FrcTable;
use corniche_spec::{
    Observer,
    inputs::{Inputs, OtherInputs},
};
use corniche_tileset::Manifest;

use super::{
    checks::{Check, Findings},
    dem_inputs,
    error::VerifyError,
    osm, osm_layers, photo_files,
};

/// The inputs with which a package is verified.
#[derive(Debug, Clone)]
pub struct VerifySettings {
    /// The elevation files it was made from, to check errors against; empty leaves that out.
    pub dem: Vec<PathBuf>,
    /// The photos it was made from, to check the photos of tiles against; empty leaves that out.
    pub photo: Vec<PathBuf>,
    /// The extract it was made from, to check roads against; `None` leaves that out.
    pub osm: Option<VerifyOsm>,
    /// The polygon that it was cut with, if it was: needed with elevation files and with an extract.
    pub polygon: Option<Polygon>,
    /// Worker threads, at least 1.
    pub threads: usize,
}

/// The extracts that a package was made from, and how they were read.
#[derive(Debug, Clone)]
pub struct VerifyOsm {
    /// The extracts.
    pub paths: Vec<PathBuf>,
    /// The FRC table that the manifest names.
    pub table: FrcTable,
    /// The table of areas that the manifest names; not asked for if the package has none.
    pub areas: Option<AreaTable>,
    /// Memory for sorting roads and areas by tile, bytes.
    pub memory_bytes: u64,
}

/// What was given beside the package.
pub(crate) struct GivenInputs {
    /// The elevation files as the build opened them; `None` inside where their grid is not the package's.
    pub dem: Option<GivenFiles<Option<(Dem, GridPlan)>>>,
    pub photo: Option<GivenFiles<()>>,
    /// The extracts, in the order in which the build read them.
    pub osm: Option<GivenFiles<Vec<PathBuf>>>,
    /// What was seen of them.
    pub(crate) findings: Findings,
}

impl GivenInputs {
    /// Fails where one of the files, or a table, is not that of the build.
    pub(crate) fn open(
        manifest: &Manifest,
        settings: &VerifySettings,
        observer: &dyn Observer,
    ) -> Result<Self, VerifyError> {
        let mut findings = Findings::default();
        let mut checks: Vec<Check> = Vec::new();
        let dem = (!settings.dem.is_empty()).then(|| {
            looked_at(Inputs::find(&settings.dem, OtherInputs::default())?, |inputs| {
                dem_inputs::open(settings, inputs, manifest, &mut checks, observer)
            })
        });
        let dem = dem.transpose()?;
        findings.merge(checks);
        let photo = (!settings.photo.is_empty()).then(|| {
            let others = OtherInputs { photo: &settings.photo, ..OtherInputs::default() };
            looked_at(Inputs::find(&[], others)?, |inputs| {
                let given = inputs.hash(observer)?;
                photo_files::check_inputs(manifest, &settings.photo, &given, &mut findings)
            })
        });
        let photo = photo.transpose()?;
        let osm = settings.osm.as_ref().map(|asked| {
            let others = OtherInputs { osm: &asked.paths, ..OtherInputs::default() };
            looked_at(Inputs::find(&[], others)?, |inputs| {
                let paths = osm::check_inputs(manifest, asked, inputs, &mut findings, observer)?;
                osm_layers::table(asked.areas.as_ref(), manifest)?;
                Ok(paths)
            })
        });
        let osm = osm.transpose()?;
        Ok(Self { dem, photo, osm, findings })
    }
}

fn looked_at<T>(
    inputs: Inputs,
    look: impl FnOnce(&Inputs) -> Result<T, VerifyError>,
) -> Result<GivenFiles<T>, VerifyError> {
    let found = look(&inputs);
    let found = VerifyError::unless_changed(&inputs, found)?;
    Ok(GivenFiles { inputs, found })
}

/// Files that are those of the build.
pub(crate) struct GivenFiles<T> {
    /// The files, to see at the end that they did not change.
    pub inputs: Inputs,
    pub found: T,
}
