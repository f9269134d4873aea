//! Arguments of `build` and `plan`: the inputs, how they are converted, and the output.

use std::{
    num::NonZeroU32,
    path::{Path, PathBuf},
};

use clap::Args;
use corniche_presets::{
    InputFiles, LayerOptions, PhotoOptions, ResourceOptions, RoadOptions, TerrainOptions,
    is_photo_off,
};

use super::voice::json_progress;

// What to build and from which inputs: the same for `build` and `plan`.
#[derive(Debug, Args)]
pub(crate) struct WorkArgs {
    #[command(flatten)]
    pub inputs: InputFiles,
    /// Attribution that must be displayed wherever the package is shown, such as that of a DEM; may
    /// be given several times
    #[arg(long, value_name = "TEXT")]
    pub attribution: Vec<String>,
    /// Settings file, which can also name inputs and outputs. Options on the command line take
    /// precedence. Paths in the file are relative to its folder
    #[arg(long, value_name = "TOML")]
    pub config: Option<PathBuf>,
    /// Start even if memory or disk space is not expected to suffice, or if the grid has more than
    /// 16 nodes per DEM sample
    #[arg(long)]
    pub force: bool,
    #[command(flatten)]
    pub terrain: TerrainOptions,
    #[command(flatten)]
    pub roads: RoadOptions,
    #[command(flatten)]
    pub layers: LayerOptions,
    #[command(flatten)]
    pub photos: PhotoOptions,
    #[command(flatten)]
    pub resources: ResourceOptions,
}

impl WorkArgs {
    /// All input files.
    pub(crate) fn files(&self) -> impl Iterator<Item = &Path> {
        let InputFiles { dem, terrain, osm, polygon, photo } = &self.inputs;
        let photo = if is_photo_off(photo) { &[] } else { &photo[..] };
        let files = dem.iter().chain(terrain).chain(osm).chain(polygon).chain(photo);
        files.chain(&self.config).map(PathBuf::as_path)
    }
}

#[derive(Debug, Args)]
#[command(arg = json_progress())]
pub(crate) struct BuildArgs {
    /// The package to write (.pmtiles)
    #[arg(short, long, value_name = "PACKAGE", required_unless_present = "config")]
    pub output: Option<PathBuf>,
    /// Overwrite the package if it exists, once the new one is complete; for a link, overwrite the
    /// file it points to
    #[arg(short = 'O', long)]
    pub overwrite: bool,
    /// Resume an interrupted build of the same package from its intermediate results
    #[arg(long)]
    pub resume: bool,
    /// Also list every defect of the extract and every lost road in this file (CSV), one per line;
    /// needs -O if the file exists
    #[arg(long, value_name = "CSV")]
    pub defects: Option<PathBuf>,
    #[command(flatten)]
    pub work: WorkArgs,
}

#[derive(Debug, Args)]
pub(crate) struct PlanArgs {
    /// Also write the plan (JSON)
    #[arg(short, long, value_name = "PLAN.json")]
    pub output: Option<PathBuf>,
    /// Overwrite the plan if it exists
    #[arg(short = 'O', long, requires = "output")]
    pub overwrite: bool,
    /// Print the estimates as JSON, for programs
    #[arg(long)]
    pub json: bool,
    /// Print only the tiles of this level that contain data, one Z/X/Y per line: the subtrees for
    /// corniche part
    #[arg(long, value_name = "LEVEL", conflicts_with = "json")]
    pub subtrees: Option<u8>,
    /// Print only the parts of the build for this number of processes, one JSON object per line, as
    /// corniche jobs does
    #[arg(long, value_name = "N", conflicts_with_all = ["json", "subtrees"])]
    pub jobs: Option<NonZeroU32>,
    #[command(flatten)]
    pub work: WorkArgs,
}
