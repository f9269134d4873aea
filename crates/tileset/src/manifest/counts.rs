//! Counts in the manifest: samples and roads read, kept, and lost by reason.

use serde::{Deserialize, Serialize};

/// Numbers of samples and roads: read, kept, and lost by reason.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ManifestCounts {
    /// Samples of the DEM.
    pub samples: SampleCounts,
    /// Roads read from the extract (ways that the FRC table knows; FRC: functional road class).
    pub roads_in: u64,
    /// The true length in plan of all roads that were read, in micrometres.
    pub roads_in_um: u64,
    /// Roads that are kept at the finest level, as a whole or in part.
    pub roads_kept: u64,
    /// The true length in plan that is kept at the finest level, in micrometres.
    pub roads_kept_um: u64,
    /// The lost roads by reason. Roads and lengths lost and kept add up to the roads and lengths
    /// read.
    pub roads_lost: Vec<RoadLoss>,
    /// Defects found in the extract, by name: missing nodes, one-node ways and so on. Sorted by
    /// name.
    pub defects: Vec<(String, u64)>,
    /// Ways by `highway` value that the FRC table does not know. Sorted by value.
    pub unknown_highways: Vec<(String, u64)>,
    /// Tags of roads that are read as another value ("layer=1000", "tunnel=culvert"), with the
    /// number of ways. Sorted by tag.
    pub tags_taken_otherwise: Vec<(String, u64)>,
    /// Blobs of the extract that have an unknown type and are skipped, as the file format requires;
    /// 0 for the extracts of common tools.
    pub blobs_passed_over: u64,
    /// Ways with a `highway` tag in the extract.
    pub highways_in: u64,
    /// Number of ways with a `highway` tag that did not become roads, by reason. Together with the
    /// ways that became roads they are all ways with this tag.
    pub highways_left_out: Vec<(String, u64)>,
    /// Ways that the FRC table excludes, with their lengths; by reason, the longest first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<LeftOutRecord>,
    /// Roads read per class, class 0 first: number and true length in micrometres.
    pub classes: Vec<(u64, u64)>,
}

/// Nodes of the finest grid in the rectangle of the data.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct SampleCounts {
    /// All nodes of the rectangle.
    pub nodes: u64,
    /// Nodes with a height from the DEM.
    pub with_data: u64,
    /// Nodes without data that were filled from their surroundings.
    pub filled: u64,
    /// Nodes that remain void (no data).
    pub void: u64,
}

/// Roads lost for one reason.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RoadLoss {
    /// The reason, as text.
    pub reason: String,
    /// Roads lost completely for this reason.
    pub roads: u64,
    /// The true length in plan lost for this reason, in micrometres.
    pub length_um: u64,
}

/// Ways that the FRC table excludes for one reason, with one `highway` value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LeftOutRecord {
    /// The reason, as text.
    pub reason: String,
    /// The value of `highway`.
    pub highway: String,
    /// Number of ways.
    pub ways: u64,
    /// The true length of the ways in plan, in micrometres; for areas the length of the outline.
    pub length_um: u64,
}

/// Growth of one class on one level: the vertices and bytes that clipping to the terrain adds.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct GrowthRow {
    /// Level.
    pub level: u8,
    /// Functional road class (FRC).
    pub class: u8,
    /// Points of the source lines of this class in tiles with ground.
    pub source_vertices: u64,
    /// Points of the level's simplified lines in tiles with ground, before lines are cut at tile
    /// borders.
    pub simplified_vertices: u64,
    /// Vertices of the clipped lines in all tiles of the level.
    pub geo_vertices: u64,
    /// Points of the lines in plan of the SV sections (roads drawn by shadow volumes).
    pub sv_vertices: u64,
    /// Bytes of the source lines as plain f64 pairs.
    pub source_bytes: u64,
    /// Bytes of the simplified lines as plain f64 pairs.
    pub simplified_bytes: u64,
    /// Bytes of the clipped lines as plain f64 triples.
    pub geo_raw_bytes: u64,
    /// Bytes of the clipped lines as stored; the bytes of a section are distributed to classes in
    /// proportion to their encoded lengths.
    pub geo_stored_bytes: u64,
    /// Bytes of the SV lines as stored, distributed to classes in the same way as those of the GEO
    /// lines.
    pub sv_stored_bytes: u64,
}

impl GrowthRow {
    /// All numbers of vertices and bytes, in the order of the fields.
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
