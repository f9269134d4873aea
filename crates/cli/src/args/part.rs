//! Commands that make a package in parts.

use std::{
    num::{NonZeroU32, NonZeroUsize},
    path::PathBuf,
};

use clap::{Args, ValueEnum};
use corniche_geom::TileId;
use corniche_pipeline::{Share, Step};

use super::ReportArgs;

/// A step of a build that a process can do alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum StepName {
    /// Hash the inputs
    Hashes,
    /// Find the road ways in a share of the extract; may be left out
    Ways,
    /// Find the nodes of road ways in a share of the extract; needs the ways of all shares
    Nodes,
    /// Cut the extract's roads by tile: from all shares of ways and nodes, else from the extract itself
    Roads,
    /// Read the heights of a subtree
    Heights,
    /// Check all heights and make what lies above the subtrees; needs the heights of all
    Top,
    /// Make the tiles of a subtree; needs the heights of all, top and roads
    Tiles,
}

impl From<StepName> for Step {
    fn from(name: StepName) -> Self {
        match name {
            StepName::Hashes => Self::Hashes,
            StepName::Ways => Self::Ways,
            StepName::Nodes => Self::Nodes,
            StepName::Roads => Self::Roads,
            StepName::Heights => Self::Heights,
            StepName::Top => Self::Top,
            StepName::Tiles => Self::Tiles,
        }
    }
}

// Which plan, which stores, and what the run may use: the same for `part` and `merge`.
#[derive(Debug, Args)]
pub(crate) struct PlannedArgs {
    /// The plan, made with corniche plan -o
    #[arg(value_name = "PLAN.json")]
    pub(crate) plan: PathBuf,
    /// Folders with parts, or prefixes in object storage (`s3://BUCKET/PREFIX`). All are read; the first is also written
    #[arg(long, value_name = "FOLDER", num_args = 1.., required = true)]
    pub(crate) store: Vec<PathBuf>,
    /// With object storage: where a part or a package is made before it is sent [default: the system's temporary folder]
    #[arg(long, value_name = "FOLDER")]
    pub(crate) tmp: Option<PathBuf>,
    /// Worker threads [default: one per processor]
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,
    /// The most memory to use, such as 512M, 4G or 1T, at least 256M [default: half of the machine's, at most 4G]
    #[arg(long, value_name = "BYTES")]
    pub(crate) memory: Option<String>,
    /// End, with exit code 1, when standard input ends: for programs that start this one and keep a pipe to it open. It ends when they
    /// do, however they end. The same command goes on from what was done
    #[arg(long)]
    pub(crate) die_with_parent: bool,
    #[command(flatten)]
    pub(crate) report: ReportArgs,
}

#[derive(Debug, Args)]
pub(crate) struct PartArgs {
    /// The step to do
    #[arg(long, value_enum, value_name = "STEP")]
    pub(crate) step: StepName,
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
pub(crate) struct JobsArgs {
    /// The plan, made with corniche plan -o
    #[arg(value_name = "PLAN.json")]
    pub(crate) plan: PathBuf,
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
