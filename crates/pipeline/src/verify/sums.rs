//! P6: nothing is dropped in silence; the manifest's sums add up.

use corniche_tileset::Manifest;

use super::Check;
use crate::build::settings_sha256;

/// Lengths measured again along the edges of TINs: every crossing moves a point by less than a millimetre. They agree to
/// this share.
pub(crate) const LENGTH_SHARE: f64 = 1e-5;

pub(crate) fn verify(manifest: &Manifest) -> Vec<Check> {
    let counts = &manifest.counts;
    let mut check = Check::new("P6: what came in is what was kept and what was lost by reason");
    let samples = &counts.samples;
    check.look(samples.nodes == samples.with_data + samples.filled + samples.void, || {
        format!("{} nodes, but {samples:?}", samples.nodes)
    });
    let lost: u64 = counts.roads_lost.iter().map(|loss| loss.roads).sum();
    check.look(counts.roads_in == counts.roads_kept + lost, || {
        format!("{} roads in, {} kept, {lost} lost", counts.roads_in, counts.roads_kept)
    });
    let lost_um: u64 = counts.roads_lost.iter().map(|loss| loss.length_um).sum();
    check.look(counts.roads_in_um == counts.roads_kept_um + lost_um, || {
        format!("{} µm in, {} µm kept, {lost_um} µm lost", counts.roads_in_um, counts.roads_kept_um)
    });
    let by_class_um: u64 = counts.classes.iter().map(|&(_, length_um)| length_um).sum();
    check.look(by_class_um == counts.roads_in_um, || {
        format!("{by_class_um} µm by class, {} µm in all", counts.roads_in_um)
    });
    let by_class: u64 = counts.classes.iter().map(|&(count, _)| count).sum();
    check.look(by_class == counts.roads_in, || {
        format!("{by_class} roads by class, {} in all", counts.roads_in)
    });
    vec![check, settings(manifest)]
}

/// Tolerances are what the settings say, and the settings are those that were hashed: else every check that rests
/// on them could be loosened.
fn settings(manifest: &Manifest) -> Check {
    let mut check = Check::new("tolerances follow from the settings, and those match their hash");
    let hash = settings_sha256(&manifest.settings);
    check.look(hash == manifest.settings_sha256, || {
        "the settings do not match their hash".to_owned()
    });
    for (level, record) in (0_u8..).zip(&manifest.levels) {
        let sound = record.level == level && level <= manifest.frame.max_level();
        let tolerance_m = if sound {
            manifest.settings.max_error_m * manifest.frame.stride(level) as f64
        } else {
            f64::NAN
        };
        // The build computes it so: equal to the last bit.
        check.look(record.max_error_m.to_bits() == tolerance_m.to_bits(), || {
            format!(
                "level {level} has a tolerance of {} m, not {tolerance_m} m",
                record.max_error_m
            )
        });
    }
    check
}
