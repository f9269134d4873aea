//! The schemas of records that write themselves: what their fields mean to readers of the JSON.

#![expect(dead_code, reason = "only their schemas are wanted")]

use corniche_geom::NodeIndex;
use corniche_pipeline::Job;
use corniche_plan::{Estimate, MemoryEstimate, Rates};
use corniche_tileset::{
    AreaLevelRecord, Distribution, LeftOutRecord, LineLevelRecord, RoadLoss, SampleCounts,
    SampleErrorRecord,
};
use corniche_verify::{ErrorFigures, GapFigures};
use schemars::{JsonSchema, schema_for};
use serde::Serialize;
use serde_json::{Value, json, to_value};

/// The areas of a level.
#[derive(JsonSchema)]
pub(crate) struct AreaLevelDocument {
    /// Level, 0 = root.
    level: u8,
    /// Tiles with areas.
    tiles: u64,
    /// Areas of these tiles; one that lies in several tiles counts in each.
    areas: u64,
    /// Points of all rings.
    points: u64,
    /// Stored bytes of their sections.
    bytes: u64,
}

/// The lines of a level.
#[derive(JsonSchema)]
pub(crate) struct LineLevelDocument {
    /// Level, 0 = root.
    level: u8,
    /// Tiles with some.
    tiles: u64,
    /// Parts of lines near these tiles; one that comes near several tiles counts in each.
    parts: u64,
    /// Their points.
    points: u64,
    /// Stored bytes of their sections.
    bytes: u64,
}

/// The distribution of values, as nearest-rank quantiles.
#[derive(JsonSchema)]
pub(crate) struct DistributionDocument {
    /// How many values.
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

/// How far TINs are from the DEM's own samples.
#[derive(JsonSchema)]
pub(crate) struct SamplesDocument {
    /// Samples at which there is a TIN.
    on_tin: u64,
    /// Samples at which there is none.
    off_tin: u64,
    /// Largest vertical distance, metres.
    max_m: f64,
    /// Root mean square, metres.
    rms_m: f64,
    /// Distance that 99 % do not exceed, metres.
    p99_m: f64,
}

/// Gaps of a level.
#[derive(JsonSchema)]
pub(crate) struct GapDocument {
    /// Level.
    level: u8,
    /// Edges looked at.
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
    /// Nodes with data that were compared.
    nodes: u64,
    /// Largest distance of a TIN from a node, metres.
    largest_true_m: f64,
    /// Stored error over true error, for the tiles where that can be measured.
    tightness: Option<DistributionDocument>,
    /// Nodes with data that the TINs do not cover.
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
    /// With a height from the DEM.
    with_data: u64,
    /// Filled from their surroundings.
    filled: u64,
    /// Left void.
    void: u64,
}

/// Roads lost for one reason.
#[derive(JsonSchema)]
pub(crate) struct LossDocument {
    /// Why, in words.
    reason: String,
    /// Roads lost altogether for this reason.
    roads: u64,
    /// True length in plan lost for this reason, micrometres.
    length_um: u64,
}

/// Ways that the FRC table leaves out for one reason, with one `highway` value.
#[derive(JsonSchema)]
pub(crate) struct LeftOutDocument {
    /// Why, in words.
    reason: String,
    /// Value of `highway`.
    highway: String,
    /// How many ways.
    ways: u64,
    /// Their true length in plan, micrometres; of areas that of the outline.
    length_um: u64,
}

/// What a build will take. All but the counts are estimates.
#[derive(JsonSchema)]
pub(crate) struct EstimateDocument {
    /// Nodes of the finest level in the files' rectangles; where files overlap they count twice.
    nodes: u64,
    /// Tiles per level, root first, if no tile is void.
    tiles: Vec<u64>,
    /// Memory.
    memory: MemoryDocument,
    /// Disk space for intermediate results, bytes.
    store_bytes: u64,
    /// Size of the package.
    package_bytes: u64,
    /// Time on one core.
    core_seconds: f64,
    /// Time on as many threads as the build has.
    seconds: f64,
    /// Where the numbers of triangles, bytes and seconds come from.
    rates: RatesDocument,
}

/// Memory that a build needs, bytes.
#[derive(JsonSchema)]
pub(crate) struct MemoryDocument {
    /// Whatever is being built.
    base_bytes: u64,
    /// For what is remembered of every tile.
    tiles_bytes: u64,
    /// Number of threads.
    threads: u64,
    /// For the work of each thread.
    thread_bytes: u64,
    /// For the largest block of a file, which GDAL decodes whole for each thread.
    block_bytes: u64,
    /// The file with that block.
    block_file: String,
    /// All blocks from the west to the east side of a file, the most of any file.
    block_row_bytes: u64,
    /// The sum that no build can do with less of.
    least_bytes: u64,
}

/// Where an estimate's rates come from.
#[derive(JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum RatesDocument {
    /// From builds of other data on another machine, as `docs/lab/build-costs.md` says.
    Recorded,
    /// From some tiles of these data, triangulated on this machine.
    Sampled {
        /// How many.
        tiles: u64,
    },
}

/// A part of a build.
#[derive(JsonSchema)]
pub(crate) struct JobDocument {
    /// A name that no other part of the plan has, such as "tiles-2-1-3".
    id: String,
    /// The step's name; "merge" for the last one.
    step: &'static str,
    /// Its subtree as "z/x/y"; null where the step has no subtrees.
    subtree: Option<String>,
    /// Its share as "i/n"; null where the step has no shares.
    share: Option<String>,
    /// Estimated time on one core, seconds.
    work: f64,
    /// Steps of which all parts must be done before.
    after: Vec<&'static str>,
    /// What to give to `corniche part` behind plan and stores; for the merge, to `corniche merge`.
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
    let estimate = Estimate {
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
    check::<AreaLevelDocument>(&AreaLevelRecord {
        level: 0,
        tiles: 1,
        areas: 1,
        points: 1,
        bytes: 1,
    });
    check::<LineLevelDocument>(&LineLevelRecord {
        level: 0,
        tiles: 1,
        parts: 1,
        points: 1,
        bytes: 1,
    });
    check::<DistributionDocument>(&Distribution::of(vec![1.0]).unwrap());
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
