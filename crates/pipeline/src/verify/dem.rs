//! Compares the package with the elevation files: inputs, grid, deviations, vertices and normals.

use corniche_tileset::{FilePackage, SampleSums};

use super::{
    checks::Findings, dem_inputs, deviation_checks, deviations, error::VerifyError,
    report::VerifyReport, samples, verify_settings::VerifySettings, vertices_against_dem,
};
use crate::{
    Observer,
    inputs::{Inputs, OtherInputs},
};

pub(crate) fn verify(
    package: &FilePackage,
    settings: &VerifySettings,
    report: &mut VerifyReport,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let inputs = Inputs::find(&settings.dem, OtherInputs::default())?;
    let compared = compare_all(package, settings, &inputs, report, observer);
    VerifyError::unless_changed(&inputs, compared)
}

fn compare_all(
    package: &FilePackage,
    settings: &VerifySettings,
    inputs: &Inputs,
    report: &mut VerifyReport,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let manifest = package.manifest();
    let Some((dem, plan)) =
        dem_inputs::open(settings, inputs, manifest, &mut report.checks, observer)?
    else {
        return Ok(());
    };
    let measured = deviations::measure(package, &dem, &plan, settings.threads, observer)?;
    let at_samples = if plan.nodes_are_samples() {
        measured.at_samples
    } else {
        samples::measure(package, &dem, &plan, settings, observer)?
    };
    let mut findings = Findings::default();
    report.errors = deviation_checks::verify(package, &measured.by_tile, &mut findings)?;
    report.checks.extend(findings);
    vertices_against_dem::verify(package, &dem, &plan, settings.threads, report, observer)?;
    report.checks.extend(samples::judge(manifest, &at_samples));
    report.samples = at_samples.last().map(SampleSums::record);
    Ok(())
}
