//! What came into a package and what became of it. Where the file has pairs, there are objects.

use corniche_tileset::{Counts, LeftOutRecord, RoadLoss, SampleCounts};
use serde::Serialize;

#[cfg(test)]
use crate::documents::record_schemas::{LeftOutDocument, LossDocument, NodeCountsDocument};

/// What came in, what was kept, what was lost and why.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct CountsDocument {
    /// Nodes of the finest grid over the data's rectangle.
    #[cfg_attr(test, schemars(with = "NodeCountsDocument"))]
    samples: SampleCounts,
    /// Roads read from the extract: ways that the FRC table knows.
    roads_in: u64,
    /// Their true length in plan, micrometres.
    roads_in_um: u64,
    /// Roads of which anything is kept at the finest level.
    roads_kept: u64,
    /// True length in plan kept at the finest level, micrometres.
    roads_kept_um: u64,
    /// The difference, by reason.
    #[cfg_attr(test, schemars(with = "Vec<LossDocument>"))]
    roads_lost: Vec<RoadLoss>,
    /// Defects met in the extract.
    defects: Vec<NamedCount>,
    /// Ways by `highway` value that the FRC table does not know.
    unknown_highways: Vec<NamedCount>,
    /// Tags of roads that are read as another value: on how many ways.
    tags_taken_otherwise: Vec<NamedCount>,
    /// Blobs of the extract that have an unknown type and are skipped.
    blobs_passed_over: u64,
    /// Ways with a `highway` tag in the extract.
    highways_in: u64,
    /// How many of them did not become roads, by reason.
    highways_left_out: Vec<NamedCount>,
    /// Those that the FRC table leaves out, with their lengths; by reason, the longest first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(with = "Vec<LeftOutDocument>"))]
    left_out: Vec<LeftOutRecord>,
    /// Roads read, by class.
    classes: Vec<ClassCount>,
}

/// How many there are of one kind.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct NamedCount {
    /// The defect, value, tag or reason.
    name: String,
    /// How many.
    count: u64,
}

impl From<(String, u64)> for NamedCount {
    fn from((name, count): (String, u64)) -> Self {
        Self { name, count }
    }
}

/// Roads of one class.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct ClassCount {
    /// Functional road class.
    class: usize,
    /// How many.
    roads: u64,
    /// Their true length in plan, micrometres.
    length_um: u64,
}

impl From<Counts> for CountsDocument {
    fn from(counts: Counts) -> Self {
        let named = |pairs: Vec<(String, u64)>| pairs.into_iter().map(Into::into).collect();
        let classes = counts.classes.iter().enumerate();
        Self {
            samples: counts.samples,
            roads_in: counts.roads_in,
            roads_in_um: counts.roads_in_um,
            roads_kept: counts.roads_kept,
            roads_kept_um: counts.roads_kept_um,
            roads_lost: counts.roads_lost,
            defects: named(counts.defects),
            unknown_highways: named(counts.unknown_highways),
            tags_taken_otherwise: named(counts.tags_taken_otherwise),
            blobs_passed_over: counts.blobs_passed_over,
            highways_in: counts.highways_in,
            highways_left_out: named(counts.highways_left_out),
            left_out: counts.left_out,
            classes: classes
                .map(|(class, &(roads, length_um))| ClassCount { class, roads, length_um })
                .collect(),
        }
    }
}
