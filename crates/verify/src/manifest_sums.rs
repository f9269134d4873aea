//! P6: the manifest's sums add up, so nothing was dropped without being counted.

use corniche_tileset::Manifest;

use super::checks::{CheckId, Findings};

/// Lengths that are measured again over the edges of TINs agree to this share: every crossing moves a point by less than
/// a millimetre.
pub(crate) const LENGTH_SHARE: f64 = 1e-5;

/// And each line may differ by this, because both of its ends may be cuts, which are put on a lattice of a millimetre.
pub(crate) const CUT_M: f64 = 0.002;

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
    let lost_um: u64 = counts.roads_lost.iter().map(|loss| loss.length_um).sum();
    findings.look(CheckId::RoadSums, counts.roads_in_um == counts.roads_kept_um + lost_um, || {
        format!("{} µm in, {} µm kept, {lost_um} µm lost", counts.roads_in_um, counts.roads_kept_um)
    });
    let by_class: u64 = counts.classes.iter().map(|&(count, _)| count).sum();
    let by_class_um: u64 = counts.classes.iter().map(|&(_, length_um)| length_um).sum();
    findings.look(
        CheckId::RoadSums,
        by_class == counts.roads_in && by_class_um == counts.roads_in_um,
        || {
            format!(
                "{by_class} roads of {by_class_um} µm by class, {} of {} µm in all",
                counts.roads_in, counts.roads_in_um
            )
        },
    );
}
