//! Counts and lengths of roads for the manifest.

use corniche_tileset::{Counts, SampleCounts};

use super::{lay::LaidSums, losses, read::ReadRoads};

/// What came in, what was kept, what was lost and why: per road, then summed.
pub(crate) fn road_counts(samples: SampleCounts, roads: &ReadRoads<'_>, laid: &LaidSums) -> Counts {
    let losses = losses::sums(roads, laid);
    Counts {
        samples,
        roads_in: roads.lengths_um.len() as u64,
        roads_in_um: roads.lengths_um.iter().sum(),
        classes: roads.classes.clone(),
        defects: roads.defects.iter().map(|(name, &count)| (name.clone(), count)).collect(),
        unknown_highways: roads
            .extract
            .unknown_highways
            .iter()
            .map(|(value, &count)| (value.clone(), count))
            .collect(),
        tags_taken_otherwise: roads
            .extract
            .tags_taken_otherwise
            .iter()
            .map(|(tag, &count)| (tag.clone(), count))
            .collect(),
        blobs_passed_over: roads.extract.blobs_passed_over,
        highways_in: roads.extract.highway_ways,
        highways_left_out: left_out(&roads.extract),
        roads_kept: losses.roads_kept,
        roads_kept_um: losses.roads_kept_um,
        roads_lost: losses.lost,
    }
}

/// Ways with a `highway` tag that are no roads here, by reason.
fn left_out(extract: &corniche_osm::ExtractSummary) -> Vec<(String, u64)> {
    let left_out = &extract.left_out;
    [
        ("listed as no road", left_out.listed),
        ("class is off", left_out.class_off),
        ("value in no class", left_out.unknown),
        ("an area", left_out.area),
        ("id occurs twice", left_out.duplicate),
        ("no line is left", left_out.without_line),
    ]
    .into_iter()
    .filter(|&(_, ways)| ways > 0)
    .map(|(reason, ways)| (reason.to_owned(), ways))
    .collect()
}
