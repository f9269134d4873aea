//! Compares the package with the elevation files: inputs, grid, deviations, vertices and normals.

use corniche_tileset::SampleSums;

use super::{
    checks::Findings, decoded_tiles::DecodedTiles, dem_inputs, deviation_checks, deviations,
    error::VerifyError, report::VerifyReport, samples, verify_settings::VerifySettings,
    vertices_against_dem,
};
use crate::{
    Observer,
    inputs::{Inputs, OtherInputs},
};

pub(crate) fn verify(
    tiles: &DecodedTiles<'_>,
    settings: &VerifySettings,
    report: &mut VerifyReport,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let inputs = Inputs::find(&settings.dem, OtherInputs::default())?;
    let compared = compare_all(tiles, settings, &inputs, report, observer);
    VerifyError::unless_changed(&inputs, compared)
}

fn compare_all(
    tiles: &DecodedTiles<'_>,
    settings: &VerifySettings,
    inputs: &Inputs,
    report: &mut VerifyReport,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let manifest = tiles.package.manifest();
    let Some((dem, plan)) =
        dem_inputs::open(settings, inputs, manifest, &mut report.checks, observer)?
    else {
        return Ok(());
    };
    let measured = deviations::measure(tiles, &dem, &plan, settings.threads, observer)?;
    let at_samples = if plan.nodes_are_samples() {
        measured.at_samples
    } else {
        samples::measure(tiles, &dem, &plan, settings, observer)?
    };
    let mut findings = Findings::default();
    report.errors = deviation_checks::verify(tiles, &measured.by_tile, &mut findings)?;
    report.checks.extend(findings);
    vertices_against_dem::verify(tiles, &dem, &plan, settings.threads, report, observer)?;
    report.checks.extend(samples::judge(manifest, &at_samples));
    report.samples = at_samples.last().map(SampleSums::record);
    Ok(())
}
