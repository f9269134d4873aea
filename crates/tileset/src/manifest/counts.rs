//! Counts in the manifest: what came in, what was kept, what was lost and why.

use serde::{Deserialize, Serialize};

/// What came in, what was kept, what was lost and why.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Counts {
    /// Samples of the DEM.
    pub samples: SampleCounts,
    /// Roads read from the extract (ways that the FRC table knows).
    pub roads_in: u64,
    /// The true length of all roads that came in, in plan, micrometres.
    pub roads_in_um: u64,
    /// Roads of which anything is kept at the finest level.
    pub roads_kept: u64,
    /// True length in plan kept at the finest level, micrometres.
    pub roads_kept_um: u64,
    /// The difference by reason; counts and lengths add up with what is kept to what came in.
    pub roads_lost: Vec<RoadLoss>,
    /// Defects met in the extract, by name: missing nodes, one-node ways and so on. Sorted by name.
    pub defects: Vec<(String, u64)>,
    /// Ways by `highway` value that the FRC table does not know. Sorted by value.
    pub unknown_highways: Vec<(String, u64)>,
    /// Tags of roads that are read as another value ("layer=1000", "tunnel=culvert"): on how many ways. Sorted by
    /// tag.
    pub tags_taken_otherwise: Vec<(String, u64)>,
    /// Blobs of the extract that have an unknown type and are skipped, as the format requires; 0 for the extracts of
    /// common tools.
    pub blobs_passed_over: u64,
    /// Ways with a `highway` tag in the extract.
    pub highways_in: u64,
    /// How many of them did not become roads, by reason. Together with the ways that became roads they give all.
    pub highways_left_out: Vec<(String, u64)>,
    /// Ways that the FRC table leaves out, with their lengths; by reason, the longest first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<LeftOutRecord>,
    /// Roads per class, 0 first: count and true micrometres in.
    pub classes: Vec<(u64, u64)>,
}

/// Nodes of the finest grid over the data's rectangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct SampleCounts {
    /// All nodes of the rectangle.
    pub nodes: u64,
    /// Nodes with a height from the DEM.
    pub with_data: u64,
    /// Filled from their surroundings.
    pub filled: u64,
    /// Left void.
    pub void: u64,
}

/// Roads lost for one reason.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RoadLoss {
    /// Why, in words.
    pub reason: String,
    /// Roads lost altogether for this reason.
    pub roads: u64,
    /// True length in plan lost for this reason, micrometres.
    pub length_um: u64,
}

/// Ways that the FRC table leaves out for one reason, with one `highway` value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LeftOutRecord {
    /// Why, in words.
    pub reason: String,
    /// Value of `highway`.
    pub highway: String,
    /// How many ways.
    pub ways: u64,
    /// The true length of the ways in plan, micrometres; of areas that of the outline.
    pub length_um: u64,
}

/// What one class costs on one level.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct GrowthRow {
    /// Level.
    pub level: u8,
    /// Functional road class.
    pub class: u8,
    /// Points of the source lines of this class that lie in tiles with ground.
    pub source_vertices: u64,
    /// Points of the level's simplified lines, before cutting at tile borders, that lie in tiles with ground.
    pub simplified_vertices: u64,
    /// Vertices of the clipped lines in all tiles of the level.
    pub geo_vertices: u64,
    /// Points of the plan lines of the SV sections.
    pub sv_vertices: u64,
    /// Bytes of the source lines as plain f64 pairs.
    pub source_bytes: u64,
    /// Bytes of the simplified lines as plain f64 pairs.
    pub simplified_bytes: u64,
    /// Bytes of the clipped lines as plain f64 triples.
    pub geo_raw_bytes: u64,
    /// Bytes of the clipped lines as stored, the section's bytes shared out by each class's encoded length.
    pub geo_stored_bytes: u64,
    /// Bytes of the SV lines as stored, shared out likewise.
    pub sv_stored_bytes: u64,
}

impl GrowthRow {
    /// All its numbers of vertices and bytes, in the order of the fields.
    #[must_use]
    pub fn counts(&self) -> [u64; 9] {
        [
            self.source_vertices,
            self.simplified_vertices,
            self.geo_vertices,
            self.sv_vertices,
            self.source_bytes,
            self.simplified_bytes,
            self.geo_raw_bytes,
            self.geo_stored_bytes,
            self.sv_stored_bytes,
        ]
    }
}
