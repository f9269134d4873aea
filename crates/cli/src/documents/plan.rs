//! `corniche plan --json`, and the lines of `corniche jobs`.

use corniche_pipeline::Job;
use corniche_plan::{BuildPlan, Estimate, MemoryEstimate, Rates};
use serde::Serialize;

/// What a build will take.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct PlanDocument {
    /// The plan's hash: equal plans make equal packages.
    pub(crate) plan_sha256: String,
    /// The estimates.
    pub(crate) estimate: EstimateDocument,
}

/// What a build will take. All but the counts are estimates.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct EstimateDocument {
    /// Nodes of the finest level in the files' rectangles; where files overlap they count twice.
    pub(crate) nodes: u64,
    /// Tiles per level, root first, if no tile is void.
    pub(crate) tiles: Vec<u64>,
    /// Memory.
    pub(crate) memory: MemoryDocument,
    /// Disk space for intermediate results, bytes.
    pub(crate) store_bytes: u64,
    /// Size of the package.
    pub(crate) package_bytes: u64,
    /// Time on one core.
    pub(crate) core_seconds: f64,
    /// Time on as many threads as the build has.
    pub(crate) seconds: f64,
    /// Where the numbers of triangles, bytes and seconds come from.
    pub(crate) rates: RatesDocument,
}

/// Memory that a build needs, bytes.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct MemoryDocument {
    /// Whatever is being built.
    pub(crate) base_bytes: u64,
    /// For what is remembered of every tile.
    pub(crate) tiles_bytes: u64,
    /// Number of threads.
    pub(crate) threads: u64,
    /// For the work of each thread.
    pub(crate) thread_bytes: u64,
    /// For the largest block of a file, which GDAL decodes whole for each thread.
    pub(crate) block_bytes: u64,
    /// The file with that block.
    pub(crate) block_file: String,
    /// All blocks from the west to the east side of a file, the most of any file.
    pub(crate) block_row_bytes: u64,
    /// The sum that no build can do with less of.
    pub(crate) least_bytes: u64,
}

/// Where an estimate's rates come from.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
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
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct JobDocument {
    /// A name that no other part of the plan has, such as "tiles-2-1-3".
    pub(crate) id: String,
    /// The step's name; "merge" for the last one.
    pub(crate) step: &'static str,
    /// Its subtree as "z/x/y"; null where the step has no subtrees.
    pub(crate) subtree: Option<String>,
    /// Its share as "i/n"; null where the step has no shares.
    pub(crate) share: Option<String>,
    /// Estimated time on one core, seconds.
    pub(crate) work: f64,
    /// Steps of which all parts must be done before.
    pub(crate) after: Vec<&'static str>,
    /// What to give to `corniche part` behind plan and stores; for the merge, to `corniche merge`.
    pub(crate) args: Vec<String>,
}

impl PlanDocument {
    pub(crate) fn new(plan: &BuildPlan, estimate: Estimate) -> Self {
        let Estimate {
            nodes,
            tiles,
            memory,
            store_bytes,
            package_bytes,
            core_seconds,
            seconds,
            rates,
        } = estimate;
        let MemoryEstimate {
            base_bytes,
            tiles_bytes,
            threads,
            thread_bytes,
            block_bytes,
            block_file,
            block_row_bytes,
            least_bytes,
        } = memory;
        let memory = MemoryDocument {
            base_bytes,
            tiles_bytes,
            threads,
            thread_bytes,
            block_bytes,
            block_file,
            block_row_bytes,
            least_bytes,
        };
        let rates = match rates {
            Rates::Recorded => RatesDocument::Recorded,
            Rates::Sampled { tiles } => RatesDocument::Sampled { tiles },
        };
        let estimate = EstimateDocument {
            nodes,
            tiles,
            memory,
            store_bytes,
            package_bytes,
            core_seconds,
            seconds,
            rates,
        };
        Self { plan_sha256: plan.hash(), estimate }
    }
}

impl From<&Job> for JobDocument {
    fn from(job: &Job) -> Self {
        let Job { id, step, subtree, share, work, after, args } = job.clone();
        Self { id, step, subtree, share, work, after, args }
    }
}
