//! Compares the package with the elevation files: inputs, grid, deviations, vertices and normals.

use corniche_dem::{Dem, GridPlan};
use corniche_spec::Observer;
use corniche_tileset::SampleSums;

use super::{
    checks::Findings, decoded_tiles::DecodedTiles, deviation_checks, deviations,
    error::VerifyError, given_files::GivenFiles, report::VerifyReport, samples,
    verify_settings::VerifySettings, vertices_against_dem,
};

pub(crate) fn verify(
    tiles: &DecodedTiles<'_>,
    files: &GivenFiles<Option<(Dem, GridPlan)>>,
    settings: &VerifySettings,
    report: &mut VerifyReport,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let Some(opened) = &files.found else { return Ok(()) };
    let compared = compare_all(tiles, opened, settings, report, observer);
    VerifyError::unless_changed(&files.inputs, compared)
}

fn compare_all(
    tiles: &DecodedTiles<'_>,
    (dem, plan): &(Dem, GridPlan),
    settings: &VerifySettings,
    report: &mut VerifyReport,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let manifest = tiles.package.manifest();
    let measured = deviations::measure(tiles, dem, plan, settings.threads, observer)?;
    let at_samples = if plan.nodes_are_samples() {
        measured.at_samples
    } else {
        samples::measure(tiles, dem, plan, settings, observer)?
    };
    let mut findings = Findings::default();
    report.errors = deviation_checks::verify(tiles, &measured.by_tile, &mut findings)?;
    report.checks.extend(findings);
    vertices_against_dem::verify(tiles, dem, plan, settings.threads, report, observer)?;
    report.checks.extend(samples::judge(manifest, &at_samples));
    report.samples = at_samples.last().map(SampleSums::record);
    Ok(())
}
