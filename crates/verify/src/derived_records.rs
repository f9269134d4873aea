//! Parts of the manifest that follow from other parts: levels from the settings, and texts that are always the same.

use corniche_spec::{Loss, levels::Levels, manifest_texts, settings_record};
use corniche_tileset::{InputKind, Manifest};

use super::checks::{CheckId, Findings, or_none};

pub(crate) fn verify(manifest: &Manifest, findings: &mut Findings) {
    let hash = settings_record::sha256(&manifest.settings);
    findings.look(CheckId::SettingsHash, hash == manifest.settings_sha256, || {
        "the settings do not match their hash".to_owned()
    });
    levels(manifest, findings);
    texts(manifest, findings);
}

/// Tolerances follow from the settings. Otherwise a larger recorded tolerance would weaken every check that uses it.
fn levels(manifest: &Manifest, findings: &mut Findings) {
    let Some(levels) = Levels::recorded(manifest) else {
        findings.look(CheckId::LevelRecords, false, || {
            let cells = manifest.settings.class_max_cell_m.iter().map(|&cell_m| or_none(cell_m));
            format!(
                "no classes can be shown by cells of {} m and a least class of {}",
                cells.collect::<Vec<_>>().join(", "),
                or_none(manifest.levels.last().and_then(|level| level.least_class))
            )
        });
        return;
    };
    let quantum_m = manifest.vertical.quantum_m;
    findings.look(
        CheckId::LevelRecords,
        quantum_m.to_bits() == levels.quantum_m().to_bits(),
        || format!("the height quantum is {quantum_m} m, not {} m", levels.quantum_m()),
    );
    for record in &manifest.levels {
        let level = record.level;
        let lengths = [record.max_error_m, record.simplify_tolerance_m, record.width_margin_m];
        let said = (record.cell_m.to_array(), lengths);
        let lengths =
            [levels.max_error_m(level), levels.simplify_tolerance_m(level), levels.margin_m(level)];
        let wanted = (manifest.frame.level_cell(level).to_array(), lengths);
        let bits = |(cell, lengths): ([f64; 2], [f64; 3])| {
            (cell.map(f64::to_bits), lengths.map(f64::to_bits))
        };
        // The build computes them in the same way, so they are equal to the last bit.
        findings.look(CheckId::LevelRecords, bits(said) == bits(wanted), || {
            format!("level {level} has cell, tolerances and margin {said:?}, not {wanted:?}")
        });
        let least = levels.least_class(level).map(corniche_roads::FunctionalRoadClass::number);
        findings.look(CheckId::LevelRecords, record.least_class == least, || {
            format!(
                "level {level} shows classes up to {}, not {}",
                or_none(record.least_class),
                or_none(least)
            )
        });
    }
}

fn texts(manifest: &Manifest, findings: &mut Findings) {
    let mut look =
        |holds: bool, what: &dyn Fn() -> String| findings.look(CheckId::Texts, holds, what);
    look(manifest.tiling == manifest_texts::TILING, &|| format!("tiling is {:?}", manifest.tiling));
    look(manifest.vertical.unit == manifest_texts::HEIGHT_UNIT, &|| {
        format!("unit is {:?}", manifest.vertical.unit)
    });
    for input in &manifest.inputs {
        look(InputKind::RECORDED.iter().any(|kind| kind.is_of(input)), &|| {
            format!("{:?} is an input of kind {:?}", input.name, input.kind)
        });
    }
    let has_roads = manifest.inputs.iter().any(|input| InputKind::Osm.is_of(input));
    let credits = manifest.attribution.iter().any(|text| text == corniche_osm::ATTRIBUTION);
    look(credits || !has_roads, &|| {
        format!("no credit for the extract: {}", manifest.attribution.join("; "))
    });
    let reasons = Loss::ALL.map(Loss::reason);
    for loss in &manifest.counts.roads_lost {
        look(reasons.contains(&loss.reason.as_str()), &|| {
            format!("roads lost as {:?}", loss.reason)
        });
    }
}
