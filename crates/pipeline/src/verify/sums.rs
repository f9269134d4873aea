//! P6: nothing is dropped in silence; the manifest's sums add up.

use corniche_tileset::Manifest;

use super::checks::{CheckId, Findings};

/// Lengths are sums of millions of floating-point numbers, and every cut moves a point by less than a
/// millimetre: they agree to this share.
pub(crate) const LENGTH_SHARE: f64 = 1e-5;

pub(crate) fn verify(manifest: &Manifest, findings: &mut Findings) {
    let counts = &manifest.counts;
    let samples = &counts.samples;
    findings.look(
        CheckId::SampleSums,
        samples.nodes == samples.with_data + samples.filled + samples.void,
        || format!("{} nodes, but {samples:?}", samples.nodes),
    );
    let lost: u64 = counts.roads_lost.iter().map(|loss| loss.roads).sum();
    findings.look(CheckId::RoadSums, counts.roads_in == counts.roads_kept + lost, || {
        format!("{} roads in, {} kept, {lost} lost", counts.roads_in, counts.roads_kept)
    });
    let lost_m: f64 = counts.roads_lost.iter().map(|loss| loss.length_m).sum();
    findings.look(
        CheckId::RoadSums,
        (counts.roads_in_m - counts.roads_kept_m - lost_m).abs()
            <= LENGTH_SHARE * counts.roads_in_m,
        || format!("{} m in, {} m kept, {lost_m} m lost", counts.roads_in_m, counts.roads_kept_m),
    );
    findings.look(
        CheckId::RoadSums,
        counts.roads_lost.iter().all(|loss| loss.length_m >= -LENGTH_SHARE * counts.roads_in_m),
        || format!("a loss is negative: {:?}", counts.roads_lost),
    );
    let by_class: u64 = counts.classes.iter().map(|&(count, _)| count).sum();
    let by_class_m: f64 = counts.classes.iter().map(|&(_, length_m)| length_m).sum();
    findings.look(
        CheckId::RoadSums,
        by_class == counts.roads_in
            && (by_class_m - counts.roads_in_m).abs() <= LENGTH_SHARE * counts.roads_in_m,
        || {
            format!(
                "{by_class} roads of {by_class_m} m by class, {} of {} m in all",
                counts.roads_in, counts.roads_in_m
            )
        },
    );
}
