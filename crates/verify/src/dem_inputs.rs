//! Checks that the elevation files are those of the build, and that they give its grid.

use std::path::PathBuf;

use corniche_dem::{Dem, GridPlan, OpenDemError, OpenOptions};
use corniche_spec::{
    Observer, data_outline::data_outline, inputs::Inputs, manifest_texts, settings_record,
};
use corniche_tileset::{InputKind, InputRecord, Manifest, SampleSums};

use super::{
    checks::{Check, CheckId, Findings, as_json},
    decoded_tiles::DecodedTiles,
    deviations,
    error::VerifyError,
    report::VerifyReport,
    samples,
    verify_settings::GivenFiles,
    verify_settings::VerifySettings,
    vertices_against_dem,
};

/// Opens the DEM as the build did and makes sure that it is the same one. If its grid is not that of the package, a check
/// is broken and the result is `None`, because nothing can be compared.
pub(crate) fn open(
    settings: &VerifySettings,
    inputs: &Inputs,
    manifest: &Manifest,
    checks: &mut Vec<Check>,
    observer: &dyn Observer,
) -> Result<Option<(Dem, GridPlan)>, VerifyError> {
    let is_dem =
        |input: &&InputRecord| InputKind::Dem.is_of(input) || InputKind::DemPart.is_of(input);
    let expected: Vec<&InputRecord> = manifest.inputs.iter().filter(is_dem).collect();
    let other = || VerifyError::OtherDem {
        given: settings.dem.clone(),
        expected: expected.iter().map(|input| input.name.clone()).collect(),
    };
    let mut terrain = settings_record::terrain(&manifest.settings);
    terrain.plan.polygon.clone_from(&settings.polygon);
    let dem = open_as_recorded(&settings.dem, &terrain.open)?;
    let given = inputs.hash(observer)?;
    let mut sizes = Check::new(CheckId::DemInputs);
    let kinds = [InputKind::Dem, InputKind::DemPart];
    if !are_recorded(kinds, &manifest.inputs, &given, are_same, &mut sizes) {
        return Err(other());
    }
    checks.push(sizes);
    let plan = dem.plan(&terrain.plan)?;
    let mut check = check_plan(&plan, manifest);
    let outline = data_outline(&dem, &plan, &dem.projection(&plan)?)?;
    // Packages of before have none.
    let recorded = manifest.data_outline();
    check.look(recorded.is_none() || outline == recorded, || {
        "the outline of the elevation files is not the one that is recorded".to_owned()
    });
    checks.push(check);
    Ok((plan.frame == manifest.frame).then_some((dem, plan)))
}

/// Opens elevation files with recorded options. Packages of before the band was recorded were made of the first one, also of files with several.
fn open_as_recorded(files: &[PathBuf], options: &OpenOptions) -> Result<Dem, OpenDemError> {
    match Dem::open(files, options) {
        Err(OpenDemError::SeveralBands { .. }) => {
            Dem::open(files, &OpenOptions { band: Some(1), ..options.clone() })
        }
        opened => opened,
    }
}

/// Whether the given files of two kinds are those that are recorded, by `are_same`, and whether these are as long as recorded.
///
/// Files are compared by content, not by name: a file may have been moved or renamed. Parts, the second kind, are sorted by their hash, because their
/// recorded order is that of their names.
pub(crate) fn are_recorded(
    kinds: [InputKind; 2],
    recorded: &[InputRecord],
    given: &[InputRecord],
    are_same: impl Fn(&[InputRecord], &[InputRecord]) -> bool,
    sizes: &mut Check,
) -> bool {
    kinds.iter().all(|kind| {
        let of_kind = |records: &[InputRecord]| {
            let of_kind = records.iter().filter(|record| kind.is_of(record));
            let mut of_kind: Vec<InputRecord> = of_kind.cloned().collect();
            if *kind == kinds[1] {
                of_kind.sort_by(|a, b| a.sha256.cmp(&b.sha256));
            }
            of_kind
        };
        let (said, found) = (of_kind(recorded), of_kind(given));
        let is_same = are_same(&said, &found);
        let pairs = said.iter().zip(&found).filter(|(said, found)| said.sha256 == found.sha256);
        for (said, found) in pairs.filter(|_| is_same) {
            sizes.look(said.bytes == found.bytes, || {
                format!("{:?} has {} bytes, {} are recorded", said.name, found.bytes, said.bytes)
            });
        }
        is_same
    })
}

/// Whether files are those that are recorded, by their content. Of files that were not used, outside the bounds of the package, there is no
/// hash; then the others must be there, as many as are recorded.
fn are_same(said: &[InputRecord], found: &[InputRecord]) -> bool {
    let hashes = |records: &[InputRecord]| -> Vec<String> {
        records.iter().map(|record| record.sha256.clone()).collect()
    };
    let (said, found) = (hashes(said), hashes(found));
    if said.iter().all(|hash| !hash.is_empty()) {
        return said == found;
    }
    said.len() == found.len()
        && said.iter().filter(|hash| !hash.is_empty()).all(|hash| found.contains(hash))
}

/// Compares the plan with what the build recorded of it in the manifest.
fn check_plan(plan: &GridPlan, manifest: &Manifest) -> Check {
    let mut check = Check::new(CheckId::DemPlan);
    let vertical = &manifest.vertical;
    let mut same = |what: &str, said: String, found: String| {
        check.look(said == found, || {
            format!("{what} is recorded as {said}, but comes out as {found}")
        });
    };
    same("frame", as_json(&manifest.frame), as_json(&plan.frame));
    same("crs", as_json(&manifest.crs), as_json(&plan.crs));
    same("metres_per_unit", as_json(&manifest.metres_per_unit), as_json(&plan.metres_per_unit));
    same("point_scale", as_json(&manifest.point_scale), as_json(&plan.point_scale));
    let scale = (plan.scale.center, plan.scale.least, plan.scale.largest);
    let said = (manifest.scale.center, manifest.scale.least, manifest.scale.largest);
    same("scale", as_json(&said), as_json(&scale));
    same("data_bounds", as_json(&manifest.data_bounds), as_json(&plan.data_bounds));
    same("wgs84_bounds", as_json(&manifest.wgs84_bounds), as_json(&plan.wgs84_bounds));
    same("clip", as_json(&manifest.clip), as_json(&plan.clip));
    same(
        "nodes_are_samples",
        as_json(&manifest.nodes_are_samples),
        as_json(&plan.nodes_are_samples()),
    );
    same("resampling", as_json(&manifest.resampling), as_json(&plan.resampling_text));
    same(
        "vertical.datum",
        as_json(&vertical.datum.as_str()),
        as_json(&manifest_texts::datum(plan)),
    );
    same("vertical.treatment", as_json(&vertical.treatment), as_json(&plan.vertical));
    if manifest_texts::has_comparable_operations(manifest) {
        let found = manifest_texts::datum_operations(&plan.datum_operations);
        check.look(manifest.datum_operations == found, || {
            manifest_texts::other_operations(&manifest.datum_operations, &found)
        });
    }
    check
}

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
    report.errors = deviations::verify(tiles, &measured.by_tile, &mut findings)?;
    report.checks.extend(findings);
    vertices_against_dem::verify(tiles, dem, plan, settings.threads, report, observer)?;
    report.checks.extend(samples::judge(manifest, &at_samples));
    report.samples = at_samples.last().map(SampleSums::record);
    Ok(())
}
