//! Verifies packages: checks every tile and every recorded number of a package.

#[macro_use]
mod checks;

pub mod area_seams;
mod attributes;
mod decoded_tiles;
mod dem_inputs;
mod derived_records;
mod deviations;
mod each_tile;
mod elevation;
mod error;
mod geo_against_sv;
mod georeference;
mod given_inputs;
mod header;
mod layers;
mod near_index;
mod network;
mod osm;
mod osm_layers;
mod osm_tile;
mod photo_files;
mod photos;
mod polygon;
mod polygon_cut;
mod read_again;
mod relief;
mod report;
mod roads_of_parent;
mod roads_on_tin;
mod samples;
mod seams;
mod span_order;
mod spans;
mod temporary_store;
mod tile_place;
mod tile_sums;
mod tiles;
mod tin_against_parent;
mod triangle_soup;
mod verify_settings;
mod vertices_against_dem;

use corniche_spec::BuildObserver;
use corniche_tileset::FilePackage;

use decoded_tiles::DecodedTiles;
use each_tile::VerifyRun;
use given_inputs::GivenInputs;

pub use self::{
    checks::{Check, CheckId, Needs},
    elevation::RecordedElevation,
    error::VerifyError,
    network::network,
    report::{ErrorFigures, GapFigures, VerifyReport},
    verify_settings::{VerifyOsm, VerifySettings},
};

/// Verifies a package. Without other inputs it checks whether the package is consistent; with the
/// elevation files, the photos or the extract it also compares the package with them. [`CheckId`]
/// lists the checks.
///
/// # Errors
/// When the package, the DEM, a photo or the extract cannot be read at all, or is not the one of
/// the build. A broken promise is a finding, not an error.
pub fn verify(
    package: &FilePackage,
    settings: &VerifySettings,
    observer: &dyn BuildObserver,
) -> Result<VerifyReport, VerifyError> {
    let report = look_at_all(package, settings, observer);
    // Not all checks read every tile to its end.
    each_tile::check_readable(package)?;
    report
}

fn look_at_all(
    package: &FilePackage,
    settings: &VerifySettings,
    observer: &dyn BuildObserver,
) -> Result<VerifyReport, VerifyError> {
    // Checked before the long work.
    if !settings.dem.is_empty() || settings.osm.is_some() || settings.polygon.is_some() {
        polygon::check(package.manifest(), settings.polygon.as_ref())?;
    }
    let GivenInputs { dem, photo, osm, findings: of_inputs } =
        GivenInputs::open(package.manifest(), settings, observer)?;
    let mut given = vec![Needs::Package];
    let run = &VerifyRun {
        package,
        tiles: DecodedTiles::new(package),
        threads: settings.threads,
        observer,
    };
    let (mut report, mut findings) = tiles::verify(run)?;
    findings.merge(of_inputs);
    photos::verify(run, &mut findings)?;
    layers::verify(run, &mut findings)?;
    spans::verify(run, &mut findings)?;
    derived_records::verify_sums(package.manifest(), &mut findings);
    derived_records::verify(package.manifest(), &mut findings);
    header::verify(package, &mut findings)?;
    derived_records::verify_grid(package.manifest(), &mut findings);
    georeference::verify(package.manifest(), &mut findings);
    if let Some(files) = &dem {
        given.push(Needs::Dem);
        if let Some(opened) = &files.found {
            let compared = dem_inputs::verify(run, opened, (&mut report, &mut findings));
            VerifyError::unless_changed(&files.inputs, compared)?;
        }
    }
    if let Some(files) = &photo {
        given.push(Needs::Photo);
        let compared = photo_files::verify(run, &settings.photo, &mut findings);
        VerifyError::unless_changed(&files.inputs, compared)?;
    }
    if let (Some(asked), Some(files)) = (&settings.osm, &osm) {
        given.push(Needs::Osm);
        let polygon = settings.polygon.as_ref();
        let compared = osm::verify(run, asked, &files.found, polygon, &mut findings);
        VerifyError::unless_changed(&files.inputs, compared)?;
    }
    report.checks = findings.into_checks(&given);
    Ok(report)
}
