//! Checks that the elevation files are those of the build, and that they give the package's grid.

use std::path::PathBuf;

use corniche_dem::{Dem, GridPlan, OpenDemError, OpenOptions};
use corniche_spec::{
    BuildObserver, data_outline::data_outline, inputs::InputFiles, manifest_texts, settings_record,
};
use corniche_tileset::{InputKind, InputRecord, Manifest, SampleSums};

use super::{
    checks::{Check, CheckId, Findings, as_json},
    deviations,
    each_tile::VerifyRun,
    error::{Result, VerifyError},
    report::VerifyReport,
    samples,
    verify_settings::VerifySettings,
    vertices_against_dem,
};

/// Opens the DEM as the build did, and checks that it is the same one. If its grid is not that of
/// the package, a check is broken and the result is `None`, because nothing can be compared.
pub(crate) fn open(
    settings: &VerifySettings,
    inputs: &InputFiles,
    manifest: &Manifest,
    checks: &mut Vec<Check>,
    observer: &dyn BuildObserver,
) -> Result<Option<(Dem, GridPlan)>> {
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
    let kinds = &[InputKind::Dem, InputKind::DemPart];
    if !are_recorded(kinds, &manifest.inputs, &given, are_same, &mut sizes) {
        return Err(other());
    }
    checks.push(sizes);
    let plan = dem.plan(&terrain.plan)?;
    let mut check = check_plan(&plan, manifest);
    let outline = data_outline(&dem, &plan, &dem.projection(&plan)?)?;
    // Older packages have no outline.
    let recorded = manifest.data_outline();
    check.look(recorded.is_none() || outline == recorded, || {
        "the outline of the elevation files differs from the recorded one".to_owned()
    });
    checks.push(check);
    Ok((plan.frame == manifest.frame).then_some((dem, plan)))
}

/// Opens elevation files with the recorded options. Older packages, which did not record the band,
/// used the first band of files with several bands.
fn open_as_recorded(files: &[PathBuf], options: &OpenOptions) -> Result<Dem, OpenDemError> {
    match Dem::open(files, options) {
        Err(OpenDemError::SeveralBands { .. }) => {
            Dem::open(files, &OpenOptions { band: Some(1), ..options.clone() })
        }
        opened => opened,
    }
}

/// Checks whether the given files are the recorded ones, by `are_same`, and whether their sizes
/// match the record.
///
/// Files are compared by content, not by name: a file may have been moved or renamed. Extracts and
/// parts are sorted by their hash: extracts may be given in any order, and the recorded order of
/// parts is that of their names.
pub(crate) fn are_recorded(
    kinds: &[InputKind],
    recorded: &[InputRecord],
    given: &[InputRecord],
    are_same: impl Fn(&[InputRecord], &[InputRecord]) -> bool,
    sizes: &mut Check,
) -> bool {
    kinds.iter().all(|kind| {
        let of_kind = |records: &[InputRecord]| {
            let of_kind = records.iter().filter(|record| kind.is_of(record));
            let mut of_kind: Vec<InputRecord> = of_kind.cloned().collect();
            if !matches!(kind, InputKind::Dem | InputKind::Photo) {
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

/// Whether files are the recorded ones, by their content. Unused files, outside the bounds of the
/// package, have no hash; only their number is compared.
fn are_same(said: &[InputRecord], found: &[InputRecord]) -> bool {
    let mut used = said.iter().filter(|input| !input.sha256.is_empty());
    if used.clone().count() == said.len() {
        return have_same_hashes(said, found);
    }
    said.len() == found.len()
        && used.all(|used| found.iter().any(|input| input.sha256 == used.sha256))
}

/// Whether files have the recorded content, one by one.
pub(crate) fn have_same_hashes(said: &[InputRecord], found: &[InputRecord]) -> bool {
    said.iter().map(|input| &input.sha256).eq(found.iter().map(|input| &input.sha256))
}

/// Compares the plan with the manifest.
fn check_plan(plan: &GridPlan, manifest: &Manifest) -> Check {
    let mut check = Check::new(CheckId::DemPlan);
    let vertical = &manifest.vertical;
    let mut same = |what: &str, said: String, found: String| {
        check.look(said == found, || {
            format!("{what} is recorded as {said}, but the inputs give {found}")
        });
    };
    macro_rules! same {
        ($($what:ident)*) => {
            $(same(stringify!($what), as_json(&manifest.$what), as_json(&plan.$what));)*
        };
    }
    same!(frame crs metres_per_unit point_scale);
    let scale = (plan.scale.center, plan.scale.least, plan.scale.largest);
    let said = (manifest.scale.center, manifest.scale.least, manifest.scale.largest);
    same("scale", as_json(&said), as_json(&scale));
    same!(data_bounds wgs84_bounds clip);
    same(
        "nodes_are_samples",
        as_json(&manifest.nodes_are_samples),
        as_json(&plan.nodes_are_samples()),
    );
    same("resampling", as_json(&manifest.resampling), as_json(&plan.resampling_text));
    same("vertical.datum", as_json(&vertical.datum), as_json(&manifest_texts::datum(plan)));
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
    run: &VerifyRun<'_>,
    opened: &(Dem, GridPlan),
    (report, findings): (&mut VerifyReport, &mut Findings),
) -> Result<()> {
    let measured = deviations::measure(run, opened)?;
    let at_samples = if opened.1.nodes_are_samples() {
        measured.at_samples
    } else {
        samples::measure(run, opened)?
    };
    report.errors = deviations::verify(&run.tiles, &measured.by_tile, findings)?;
    vertices_against_dem::verify(run, opened, findings)?;
    findings.merge(samples::judge(run.package.manifest(), &at_samples));
    report.samples = at_samples.last().map(SampleSums::record);
    Ok(())
}
