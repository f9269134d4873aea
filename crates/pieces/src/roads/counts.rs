//! Counts and lengths of roads for the manifest.

use corniche_tileset::{Counts, SampleCounts};

use super::{losses::Sums, totals::RoadTotals};

/// What came in, what was kept, what was lost and why: per road, then summed.
#[must_use]
pub fn road_counts(samples: SampleCounts, roads: &RoadTotals, losses: &Sums) -> Counts {
    let extract = &roads.extract;
    Counts {
        samples,
        roads_in: roads.roads,
        roads_in_um: roads.length_um,
        classes: roads.classes.clone(),
        defects: roads.defects.iter().map(|(name, &count)| (name.clone(), count)).collect(),
        unknown_highways: extract.unknown_highways.clone(),
        tags_taken_otherwise: extract.tags_taken_otherwise.clone(),
        blobs_passed_over: extract.blobs_passed_over,
        highways_in: extract.highways_in,
        highways_left_out: extract.highways_left_out.clone(),
        left_out: extract.left_out.clone(),
        roads_kept: losses.roads_kept,
        roads_kept_um: losses.roads_kept_um,
        roads_lost: losses.lost.clone(),
    }
}
