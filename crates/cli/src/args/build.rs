//! Arguments of `build` and `plan`: what to read, what to make of it and where to write it.

use std::{
    num::NonZeroU32,
    path::{Path, PathBuf},
};

use clap::Args;
use corniche_presets::{
    AreaOptions, InputFiles, PhotoOptions, ResourceOptions, RoadOptions, TerrainOptions,
    is_photo_off,
};

use super::voice::json_progress;

// What to make and with what: the same for `build` and `plan`.
#[derive(Debug, Args)]
pub(crate) struct WorkArgs {
    #[command(flatten)]
    pub(crate) inputs: InputFiles,
    /// Credit to show wherever the package is shown, such as that of a DEM; may be given several times
    #[arg(long, value_name = "TEXT")]
    pub(crate) attribution: Vec<String>,
    /// Settings file, which can name inputs and outputs, too; options on the command line have precedence over it. Paths in it begin at
    /// the folder that it is in
    #[arg(long, value_name = "TOML")]
    pub(crate) config: Option<PathBuf>,
    /// Begin although memory or disk space are not expected to suffice, or there are more than 16 nodes per DEM sample
    #[arg(long)]
    pub(crate) force: bool,
    #[command(flatten)]
    pub(crate) terrain: TerrainOptions,
    #[command(flatten)]
    pub(crate) roads: RoadOptions,
    #[command(flatten)]
    pub(crate) areas: AreaOptions,
    #[command(flatten)]
    pub(crate) photos: PhotoOptions,
    #[command(flatten)]
    pub(crate) resources: ResourceOptions,
}

impl WorkArgs {
    /// All files that are read.
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
    pub(crate) output: Option<PathBuf>,
    /// Replace the package if it exists, once the new one is complete; if it is a link, replace the file it leads to
    #[arg(short = 'O', long)]
    pub(crate) overwrite: bool,
    /// Go on with a build of the same package that was stopped, from its intermediate results
    #[arg(long)]
    pub(crate) resume: bool,
    /// Also list every defect of the extract and every road lost, one per line (CSV); an existing list is kept
    /// unless -O is given
    #[arg(long, value_name = "CSV")]
    pub(crate) defects: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) work: WorkArgs,
}

#[derive(Debug, Args)]
pub(crate) struct PlanArgs {
    /// Also write the plan (JSON)
    #[arg(short, long, value_name = "PLAN.json")]
    pub(crate) output: Option<PathBuf>,
    /// Replace the plan if it exists
    #[arg(short = 'O', long, requires = "output")]
    pub(crate) overwrite: bool,
    /// Print the estimates as JSON, for programs
    #[arg(long)]
    pub(crate) json: bool,
    /// Print only the tiles of this level that hold data, one Z/X/Y per line: subtrees for corniche part
    #[arg(long, value_name = "LEVEL", conflicts_with = "json")]
    pub(crate) subtrees: Option<u8>,
    /// Print only the parts of the build for so many processes at once, one JSON object per line, as corniche jobs does
    #[arg(long, value_name = "N", conflicts_with_all = ["json", "subtrees"])]
    pub(crate) jobs: Option<NonZeroU32>,
    #[command(flatten)]
    pub(crate) work: WorkArgs,
}
