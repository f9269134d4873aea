//! Checks that the elevation files are those of the build, and that they give its grid.

use std::path::PathBuf;

use corniche_dem::{Dem, GridPlan, OpenDemError, OpenOptions};
use corniche_spec::{
    Observer, data_outline::data_outline, inputs::Inputs, manifest_texts, settings_record,
};
use corniche_tileset::{InputKind, InputRecord, Manifest};

use super::{
    checks::{Check, CheckId, as_json},
    error::VerifyError,
    verify_settings::VerifySettings,
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
    // Files are compared by content, not by name: a file may have been moved or renamed. Parts are sorted by their hash,
    // because their recorded order is that of their names.
    let mut sizes = Check::new(CheckId::DemInputs);
    for kind in [InputKind::Dem, InputKind::DemPart] {
        let of_kind = |records: &mut dyn Iterator<Item = &InputRecord>| {
            let mut found: Vec<InputRecord> =
                records.filter(|record| kind.is_of(record)).cloned().collect();
            if kind == InputKind::DemPart {
                found.sort_by(|a, b| a.sha256.cmp(&b.sha256));
            }
            found
        };
        let (said, found) = (of_kind(&mut expected.iter().copied()), of_kind(&mut given.iter()));
        if !are_same(&said, &found) {
            return Err(other());
        }
        let pairs = said.iter().zip(&found).filter(|(said, found)| said.sha256 == found.sha256);
        for (said, found) in pairs {
            sizes.look(said.bytes == found.bytes, || {
                format!("{:?} has {} bytes, {} are recorded", said.name, found.bytes, said.bytes)
            });
        }
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
