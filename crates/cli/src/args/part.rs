//! Commands that compute a package in parts.

use std::{num::NonZeroU32, path::PathBuf};

use clap::{Args, builder::TypedValueParser};
use corniche_geom::TileId;
use corniche_osm::Share;
use corniche_pipeline::PartStep;
use corniche_presets::one_of;

use super::{shared::ThreadsArg, voice::json_progress};
use crate::failure::Result;

/// The steps of a build that a process can do alone.
fn step() -> impl TypedValueParser<Value = PartStep> {
    let help = |step| match step {
        PartStep::Hashes => "Hash the inputs",
        PartStep::Ways => "Find the road ways in a chunk of the extract; may be skipped",
        PartStep::Nodes => {
            "Find the nodes of road ways in a chunk of the extract; needs the ways of all chunks"
        }
        PartStep::Roads => {
            "Clip the extract's roads to tiles: from all chunks of ways and nodes, or from the extract itself"
        }
        PartStep::Heights => "Read the heights of a subtree",
        PartStep::Top => {
            "Check all heights and compute the levels above the subtrees; needs the heights of all subtrees"
        }
        PartStep::Tiles => {
            "Compute the tiles of a subtree; needs the heights of all subtrees, top and roads"
        }
    };
    one_of(PartStep::ALL.map(|step| (step.name(), help(step), step)))
}

// The plan, the stores and the resources of the run: the same for `part` and `merge`.
#[derive(Debug, Args)]
#[command(arg = json_progress())]
pub(crate) struct PlannedArgs {
    /// The plan, created with corniche plan -o
    #[arg(value_name = "PLAN.json")]
    pub plan: Option<PathBuf>,
    /// Folders of parts, or prefixes in object storage (`s3://BUCKET/PREFIX`). All are read; only
    /// the first is written
    #[arg(long, value_name = "FOLDER", num_args = 1.., required = true)]
    pub store: Vec<PathBuf>,
    /// With object storage: folder for parts and packages before they are uploaded [default: the
    /// system's temporary folder]
    #[arg(long, value_name = "FOLDER")]
    pub tmp: Option<PathBuf>,
    #[command(flatten)]
    pub cpu: ThreadsArg,
    /// Memory limit, at least 256M, such as 512M or 4G (M is 2^20 bytes, MB is 10^6) [default: half
    /// of the machine's memory, at most 4G]
    #[arg(long, value_name = "BYTES")]
    pub memory: Option<String>,
}

/// The plan and the stores. `--store` consumes all words that follow it, including a plan, which
/// its name identifies.
///
/// # Errors
/// When no plan is named, or the plan is ambiguous.
pub(crate) fn plan_and_stores(
    plan: Option<&PathBuf>,
    store: &[PathBuf],
) -> Result<(PathBuf, Vec<PathBuf>)> {
    if let Some(plan) = plan {
        return Ok((plan.clone(), store.to_vec()));
    }
    let is_plan = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "json");
    let (mut plans, stores): (Vec<_>, Vec<_>) = store.iter().cloned().partition(is_plan);
    match (plans.pop(), plans.is_empty()) {
        (Some(_), true) if stores.is_empty() && store.len() == 1 => Err(unusable!(
            "--store needs a folder, but only a plan follows it; write the plan first: PLAN.json --store FOLDER..."
        )),
        (Some(plan), true) => Ok((plan, stores)),
        (Some(_), false) => Err(unusable!(
            "several names after --store have the extension .json; write the plan first: PLAN.json --store FOLDER..."
        )),
        (None, _) => Err(unusable!(
            "no plan is named: no name has the extension .json; write the plan first: PLAN.json --store FOLDER..."
        )),
    }
}

#[derive(Debug, Args)]
#[command(override_usage = "corniche part [OPTIONS] --step <STEP> --store <FOLDER>... <PLAN.json>")]
pub(crate) struct PartArgs {
    /// The step to run
    #[arg(long, value_parser = step(), value_name = "STEP")]
    pub step: PartStep,
    /// For the steps heights and tiles: only this tile and its descendants [default: 0/0/0, all]
    #[arg(long, value_name = "Z/X/Y")]
    pub subtree: Option<TileId>,
    /// For the steps ways and nodes: only chunk I of N of the extract; N is the same for all
    /// chunks, at most 256 [default: 1/1, all]
    #[arg(long, value_name = "I/N")]
    pub share: Option<Share>,
    #[command(flatten)]
    pub planned: PlannedArgs,
}

#[derive(Debug, Args)]
#[command(override_usage = "corniche jobs [OPTIONS] --slots <N> <PLAN.json>")]
pub(crate) struct JobsArgs {
    /// The plan, created with corniche plan -o
    #[arg(value_name = "PLAN.json", required_unless_present = "store")]
    pub plan: Option<PathBuf>,
    /// Number of processes that will run at once
    #[arg(long, value_name = "N")]
    pub slots: NonZeroU32,
    /// Stores of parts. Once they contain the roads, the parts of the step tiles are also sized by
    /// the roads of each tile
    #[arg(long, value_name = "STORE", num_args = 1..)]
    pub store: Vec<PathBuf>,
    /// Smallest size of a part, in estimated seconds on one core, unless a smaller one is
    /// unavoidable [default: 20 times the start-up time of a part]
    #[arg(long, value_name = "SECONDS")]
    pub least_work: Option<f64>,
}

#[derive(Debug, Args)]
#[command(override_usage = "corniche merge [OPTIONS] --store <FOLDER>... -o <PACKAGE> <PLAN.json>")]
pub(crate) struct MergeArgs {
    /// The package to write (.pmtiles): a file, or an object (`s3://BUCKET/NAME.pmtiles`)
    #[arg(short, long, value_name = "PACKAGE")]
    pub output: PathBuf,
    /// Overwrite the package if it exists, once the new one is complete; for a link, overwrite the
    /// file it points to
    #[arg(short = 'O', long)]
    pub overwrite: bool,
    /// Also list every defect of the extract and every lost road in this file (CSV), one per line;
    /// needs -O if the file exists
    #[arg(long, value_name = "CSV")]
    pub defects: Option<PathBuf>,
    #[command(flatten)]
    pub planned: PlannedArgs,
}
