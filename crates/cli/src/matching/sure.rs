//! Which offsets an image shows.

use corniche_matching::{MatchedRoad, Offset};

/// Below this, or with fewer places, a best shift is one that chance may give.
pub(crate) const LEAST_CONFIDENCE: f64 = 6.0;
pub(crate) const LEAST_PLACES: u64 = 200;
/// The same for a single road.
const LEAST_PLACES_OF_A_ROAD: u64 = 24;

/// Whether an offset is one that the image shows.
pub(crate) fn is_sure(offset: &Offset, places: u64) -> bool {
    offset.confidence >= LEAST_CONFIDENCE && places >= LEAST_PLACES && !offset.is_at_edge
}

/// The offset across a road in metres, if the image shows it.
pub(crate) fn sure_across(road: &MatchedRoad) -> Option<f64> {
    let sure = road.across_offset.filter(|across| {
        across.confidence >= LEAST_CONFIDENCE
            && road.samples >= LEAST_PLACES_OF_A_ROAD
            && !across.is_at_edge
    });
    sure.map(|across| across.metres)
}
