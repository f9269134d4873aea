//! Samples along roads, with the direction of the road at each.

use geo::{Euclidean, InterpolatePoint as _, Length as _, LineString};

/// Metres between samples.
const SPACING_M: f64 = 4.0;

/// A place on a road.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RoadSample {
    /// Working metres.
    pub at: [f64; 2],
    /// The direction to the left of the road, of length 1.
    pub normal: [f64; 2],
}

/// Returns samples in the middles of equal parts of a line; none if the line has no length.
pub(crate) fn samples(line: &[[f64; 2]]) -> Vec<RoadSample> {
    let line = LineString::from(line.to_vec());
    let total = Euclidean.length(&line);
    let count = (total / SPACING_M).ceil();
    if count < 1.0 {
        return Vec::new();
    }
    let spacing = total / count;
    let mut samples = Vec::with_capacity(count as usize);
    let mut next = spacing / 2.0;
    let mut before = 0.0;
    for segment in line.lines() {
        let own = Euclidean.length(&segment);
        while own > 0.0 && next < before + own && samples.len() < count as usize {
            let share = (next - before) / own;
            let (from, to) = (segment.start_point(), segment.end_point());
            let at = Euclidean.point_at_ratio_between(from, to, share);
            let normal = [-segment.dy() / own, segment.dx() / own];
            samples.push(RoadSample { at: at.into(), normal });
            next += spacing;
        }
        before += own;
    }
    samples
}

#[cfg(test)]
#[path = "samples_tests.rs"]
mod tests;
