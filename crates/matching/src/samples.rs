//! Samples along roads, with the direction of the road at each.

/// Metres between samples.
const SPACING_M: f64 = 4.0;

/// A place on a road.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sample {
    /// Working metres.
    pub(crate) at: [f64; 2],
    /// The direction to the left of the road, of length 1.
    pub(crate) normal: [f64; 2],
}

/// Samples in the middles of equal parts of a line; none on a line that has no length.
pub(crate) fn samples(line: &[[f64; 2]]) -> Vec<Sample> {
    let length = |pair: &[[f64; 2]; 2]| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]);
    let segments = || line.array_windows::<2>();
    let total: f64 = segments().map(length).sum();
    let count = (total / SPACING_M).ceil();
    if count < 1.0 {
        return Vec::new();
    }
    let spacing = total / count;
    let mut samples = Vec::with_capacity(count as usize);
    let mut next = spacing / 2.0;
    let mut before = 0.0;
    for pair in segments() {
        let own = length(pair);
        while own > 0.0 && next < before + own && samples.len() < count as usize {
            let share = (next - before) / own;
            let [east, north] = [0, 1].map(|axis| pair[1][axis] - pair[0][axis]);
            let at = [pair[0][0] + east * share, pair[0][1] + north * share];
            samples.push(Sample { at, normal: [-north / own, east / own] });
            next += spacing;
        }
        before += own;
    }
    samples
}

#[cfg(test)]
#[path = "samples_tests.rs"]
mod tests;
