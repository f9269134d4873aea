//! Commands that make a package in parts.

use std::{num::NonZeroU32, path::PathBuf};

use clap::{Args, builder::TypedValueParser};
use corniche_geom::TileId;
use corniche_osm::Share;
use corniche_pipeline::Step;
use corniche_presets::one_of;

use super::{shared::ThreadsArg, voice::json_progress};
use crate::failure::Failure;

/// A step of a build that a process can do alone.
fn step() -> impl TypedValueParser<Value = Step> {
    let help = |step| match step {
        Step::Hashes => "Hash the inputs",
        Step::Ways => "Find the road ways in a share of the extract; may be left out",
        Step::Nodes => {
            "Find the nodes of road ways in a share of the extract; needs the ways of all shares"
        }
        Step::Roads => {
            "Cut the extract's roads by tile: from all shares of ways and nodes, else from the extract itself"
        }
        Step::Heights => "Read the heights of a subtree",
        Step::Top => {
            "Check all heights and make what lies above the subtrees; needs the heights of all"
        }
        Step::Tiles => "Make the tiles of a subtree; needs the heights of all, top and roads",
    };
    one_of(Step::ALL.map(|step| (step.name(), help(step), step)))
}

// Which plan, which stores, and what the run may use: the same for `part` and `merge`.
#[derive(Debug, Args)]
#[command(arg = json_progress())]
pub(crate) struct PlannedArgs {
    /// The plan, made with corniche plan -o
    #[arg(value_name = "PLAN.json")]
    pub(crate) plan: Option<PathBuf>,
    /// Folders with parts, or prefixes in object storage (`s3://BUCKET/PREFIX`). All are read; the first is also written
    #[arg(long, value_name = "FOLDER", num_args = 1.., required = true)]
    pub(crate) store: Vec<PathBuf>,
    /// With object storage: where a part or a package is made before it is sent [default: the system's temporary folder]
    #[arg(long, value_name = "FOLDER")]
    pub(crate) tmp: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) cpu: ThreadsArg,
    /// The most memory to use, such as 512M, 4G or 1T, at least 256M [default: half of the machine's, at most 4G]
    #[arg(long, value_name = "BYTES")]
    pub(crate) memory: Option<String>,
}

/// The plan and the stores. `--store` takes all that follows it, also a plan, which is told from stores by its name.
///
/// # Errors
/// When no plan is named, or several may be meant.
pub(crate) fn plan_and_stores(
    plan: Option<&PathBuf>,
    store: &[PathBuf],
) -> Result<(PathBuf, Vec<PathBuf>), Failure> {
    if let Some(plan) = plan {
        return Ok((plan.clone(), store.to_vec()));
    }
    let is_plan = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "json");
    let (mut plans, stores): (Vec<_>, Vec<_>) = store.iter().cloned().partition(is_plan);
    match (plans.pop(), plans.is_empty()) {
        (Some(_), true) if stores.is_empty() && store.len() == 1 => Err(Failure::unusable(
            "--store needs a folder; what is named there is a plan: give the plan first, then --store FOLDER...",
        )),
        (Some(plan), true) => Ok((plan, stores)),
        (Some(_), false) => Err(Failure::unusable(
            "several names behind --store end in .json; write the plan first: PLAN.json --store FOLDER...",
        )),
        (None, _) => Err(Failure::unusable(
            "no plan is named: none of the names ends in .json; write it first: PLAN.json --store FOLDER...",
        )),
    }
}

#[derive(Debug, Args)]
#[command(override_usage = "corniche part [OPTIONS] --step <STEP> --store <FOLDER>... <PLAN.json>")]
pub(crate) struct PartArgs {
    /// The step to do
    #[arg(long, value_parser = step(), value_name = "STEP")]
    pub(crate) step: Step,
    /// Only the tiles beneath and at this one, for the steps heights and tiles [default: 0/0/0, all]
    #[arg(long, value_name = "Z/X/Y")]
    pub(crate) subtree: Option<TileId>,
    /// Only this share of the extract, for the steps ways and nodes; N is the same for all of them, at most 256 [default: 1/1,
    /// all]
    #[arg(long, value_name = "I/N")]
    pub(crate) share: Option<Share>,
    #[command(flatten)]
    pub(crate) planned: PlannedArgs,
}

#[derive(Debug, Args)]
#[command(override_usage = "corniche jobs [OPTIONS] --slots <N> <PLAN.json>")]
pub(crate) struct JobsArgs {
    /// The plan, made with corniche plan -o
    #[arg(value_name = "PLAN.json", required_unless_present = "store")]
    pub(crate) plan: Option<PathBuf>,
    /// How many processes will work at once
    #[arg(long, value_name = "N")]
    pub(crate) slots: NonZeroU32,
    /// Stores with parts. Once the roads are in them, the parts of the step tiles are sized by the roads of each tile, too
    #[arg(long, value_name = "STORE", num_args = 1..)]
    pub(crate) store: Vec<PathBuf>,
    /// Make no part smaller than this without need, in estimated seconds on one core [default: 20 times what the start of a part
    /// takes]
    #[arg(long, value_name = "SECONDS")]
    pub(crate) least_work: Option<f64>,
}

#[derive(Debug, Args)]
#[command(override_usage = "corniche merge [OPTIONS] --store <FOLDER>... -o <PACKAGE> <PLAN.json>")]
pub(crate) struct MergeArgs {
    /// The package to write (.pmtiles): a file, or an object (`s3://BUCKET/NAME.pmtiles`)
    #[arg(short, long, value_name = "PACKAGE")]
    pub(crate) output: PathBuf,
    /// Replace the package if it exists, once the new one is complete; if it is a link, replace the file it leads to
    #[arg(short = 'O', long)]
    pub(crate) overwrite: bool,
    /// Also list every defect of the extract and every road lost, one per line (CSV); an existing list is kept
    /// unless -O is given
    #[arg(long, value_name = "CSV")]
    pub(crate) defects: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) planned: PlannedArgs,
}
