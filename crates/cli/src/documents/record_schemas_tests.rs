//! The schemas of records with their own serialization: the meanings of their fields for readers of
//! the JSON.

#![expect(dead_code, reason = "only their schemas are wanted")]

use corniche_geom::NodeIndex;
use corniche_pipeline::Job;
use corniche_plan::{BuildEstimate, MemoryEstimate, Rates};
use corniche_tileset::{
    Distribution, LeftOutRecord, RoadLoss, SampleCounts, SampleErrorRecord, SectionLevelRecord,
};
use corniche_verify::{ErrorFigures, GapFigures};
use schemars::{JsonSchema, schema_for};
use serde::Serialize;
use serde_json::{Value, json, to_value};

/// A layer, or bridges and tunnels, on a level.
#[derive(JsonSchema)]
pub(crate) struct SectionLevelDocument {
    /// Level, 0 = root.
    level: u8,
    /// Tiles with objects.
    tiles: u64,
    /// Objects, or parts of them, in or near these tiles; an object in several tiles counts in
    /// each.
    parts: u64,
    /// Points of these parts.
    points: u64,
    /// Stored bytes of the sections.
    bytes: u64,
}

/// The distribution of values, as nearest-rank quantiles.
#[derive(JsonSchema)]
pub(crate) struct DistributionDocument {
    /// Number of values.
    count: u64,
    /// Smallest.
    min: f64,
    /// Median.
    median: f64,
    /// 95th percentile.
    p95: f64,
    /// Largest.
    max: f64,
}

/// Differences between TINs and the DEM's own samples.
#[derive(JsonSchema)]
pub(crate) struct SamplesDocument {
    /// Samples that a TIN covers.
    on_tin: u64,
    /// Samples that no TIN covers.
    off_tin: u64,
    /// Largest vertical distance, metres.
    max_m: f64,
    /// Root mean square, metres.
    rms_m: f64,
    /// Distance that 99 % do not exceed, metres.
    p99_m: f64,
}

/// Gaps between roads and terrain on a level.
#[derive(JsonSchema)]
pub(crate) struct GapDocument {
    /// Level.
    level: u8,
    /// Edges checked.
    edges: u64,
    /// Largest gap, metres.
    largest_m: f64,
}

/// Errors of a level.
#[derive(JsonSchema)]
pub(crate) struct ErrorDocument {
    /// Level.
    level: u8,
    /// Tiles measured.
    tiles: u64,
    /// Nodes with a height that were compared.
    nodes: u64,
    /// Largest distance between a TIN and a node, metres.
    largest_true_m: f64,
    /// Ratio of stored error to true error, for the tiles where it can be measured.
    tightness: Option<DistributionDocument>,
    /// Nodes with a height that the TINs do not cover.
    uncovered_nodes: u64,
}

/// A node of the grid.
#[derive(JsonSchema)]
pub(crate) struct NodeDocument {
    /// Nodes east of the origin.
    i: i64,
    /// Nodes north of the origin.
    j: i64,
}

/// Nodes of the finest grid.
#[derive(JsonSchema)]
pub(crate) struct NodeCountsDocument {
    /// All nodes of the rectangle.
    nodes: u64,
    /// Nodes with a height from the DEM.
    with_data: u64,
    /// Nodes filled from their surroundings.
    filled: u64,
    /// Nodes that are void.
    void: u64,
}

/// Roads lost for one reason.
#[derive(JsonSchema)]
pub(crate) struct LossDocument {
    /// The reason, in words.
    reason: String,
    /// Roads lost completely for this reason.
    roads: u64,
    /// True length in plan lost for this reason, micrometres.
    length_um: u64,
}

/// OSM ways that the FRC table skips for one reason, with one `highway` value.
#[derive(JsonSchema)]
pub(crate) struct LeftOutDocument {
    /// The reason, in words.
    reason: String,
    /// Value of `highway`.
    highway: String,
    /// Number of OSM ways.
    ways: u64,
    /// True length in plan, micrometres; for areas that of the outline.
    length_um: u64,
}

/// Estimates for a build. Only the counts are exact.
#[derive(JsonSchema)]
pub(crate) struct EstimateDocument {
    /// Nodes of the finest level in the files' rectangles; where files overlap they count twice.
    nodes: u64,
    /// Tiles per level, root first, if no tile is void.
    tiles: Vec<u64>,
    /// Memory that the build needs.
    memory: MemoryDocument,
    /// Disk space for intermediate results, bytes.
    store_bytes: u64,
    /// Size of the package.
    package_bytes: u64,
    /// Time on one core, seconds.
    core_seconds: f64,
    /// Time on the build's number of threads, seconds.
    seconds: f64,
    /// Source of the rates of triangles, bytes and seconds.
    rates: RatesDocument,
}

/// Memory that a build needs, bytes.
#[derive(JsonSchema)]
pub(crate) struct MemoryDocument {
    /// Memory of the program itself, for any build.
    base_bytes: u64,
    /// Memory for the list of all tiles.
    tiles_bytes: u64,
    /// Number of threads.
    threads: u64,
    /// Memory for the work of each thread.
    thread_bytes: u64,
    /// Memory for the largest block of a file, which GDAL decodes as a whole for each thread.
    block_bytes: u64,
    /// The file with that block.
    block_file: String,
    /// Memory for a row of blocks from the west to the east side of a file, the largest of all
    /// files.
    block_row_bytes: u64,
    /// The sum, which is the minimum for this build.
    least_bytes: u64,
}

/// The source of an estimate's rates.
#[derive(JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum RatesDocument {
    /// Builds of other data on another machine, see `docs/lab/build-costs.md`.
    Recorded,
    /// Some tiles of this data, triangulated on this machine.
    Sampled {
        /// Number of tiles.
        tiles: u64,
    },
}

/// A part of a build.
#[derive(JsonSchema)]
pub(crate) struct JobDocument {
    /// An id that is unique within the plan, such as "tiles-2-1-3".
    id: String,
    /// Name of the step; "merge" for the last one.
    step: &'static str,
    /// The subtree as "z/x/y"; null for steps without subtrees.
    subtree: Option<String>,
    /// The share of the extract as "i/n"; null for steps without shares.
    share: Option<String>,
    /// Estimated time on one core, seconds.
    work: f64,
    /// Steps whose parts must all be complete before.
    after: Vec<&'static str>,
    /// Arguments for `corniche part` after plan and stores; for the merge, for `corniche merge`.
    args: Vec<String>,
}

/// The fields that a record writes are those of its schema.
#[test]
fn records_have_the_fields_of_their_schemas() {
    fn check<Document: JsonSchema>(record: &impl Serialize) {
        let names = |fields: &Value| -> Vec<String> {
            fields.as_object().unwrap().keys().cloned().collect()
        };
        let schema = to_value(schema_for!(Document)).unwrap();
        let written = to_value(record).unwrap();
        assert_eq!(names(&written), names(&schema["properties"]), "{}", schema["title"]);
    }
    let memory = MemoryEstimate {
        base_bytes: 1,
        tiles_bytes: 1,
        threads: 1,
        thread_bytes: 1,
        block_bytes: 1,
        block_file: "a.tif".to_owned(),
        block_row_bytes: 1,
        least_bytes: 1,
    };
    check::<MemoryDocument>(&memory);
    let estimate = BuildEstimate {
        nodes: 1,
        tiles: vec![1],
        memory,
        store_bytes: 1,
        package_bytes: 1,
        core_seconds: 1.0,
        seconds: 1.0,
        rates: Rates::Recorded,
    };
    check::<EstimateDocument>(&estimate);
    assert_eq!(to_value(Rates::Recorded).unwrap(), json!("recorded"));
    assert_eq!(to_value(Rates::Sampled { tiles: 3 }).unwrap(), json!({"sampled": {"tiles": 3}}));
    check::<JobDocument>(&Job {
        id: "tiles-2-1-3".to_owned(),
        step: "tiles",
        subtree: None,
        share: None,
        work: 1.0,
        after: Vec::new(),
        args: Vec::new(),
    });
    check::<SectionLevelDocument>(&SectionLevelRecord {
        level: 0,
        tiles: 1,
        parts: 1,
        points: 1,
        bytes: 1,
    });
    check::<DistributionDocument>(&Distribution::from_values(vec![1.0]).unwrap());
    check::<SamplesDocument>(&SampleErrorRecord::default());
    check::<GapDocument>(&GapFigures::default());
    check::<ErrorDocument>(&ErrorFigures {
        level: 0,
        tiles: 1,
        nodes: 1,
        largest_true_m: 1.0,
        tightness: None,
        uncovered_nodes: 1,
    });
    check::<NodeDocument>(&NodeIndex { i: 1, j: 2 });
    check::<NodeCountsDocument>(&SampleCounts::default());
    check::<LossDocument>(&RoadLoss { reason: String::new(), roads: 1, length_um: 1 });
    let [reason, highway] = ["", ""].map(str::to_owned);
    check::<LeftOutDocument>(&LeftOutRecord { reason, highway, ways: 1, length_um: 1 });
}
