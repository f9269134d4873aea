use std::path::PathBuf;

use clap::Args;
use corniche_presets::{ResourceOptions, RoadOptions, TerrainOptions};

#[derive(Debug, Args)]
pub(crate) struct BuildArgs {
    /// Elevation rasters, any format GDAL reads; where they overlap, the first has precedence
    #[arg(long, value_name = "FILE", num_args = 1.., required = true)]
    pub(crate) dem: Vec<PathBuf>,
    /// OpenStreetMap extract (.osm.pbf); without it the package is terrain alone
    #[arg(long, value_name = "FILE")]
    pub(crate) osm: Option<PathBuf>,
    /// The package to write (.pmtiles)
    #[arg(short, long, value_name = "PACKAGE")]
    pub(crate) output: PathBuf,
    /// Replace the package if it exists, once the new one is complete; of a link, the file it leads to
    #[arg(short = 'O', long)]
    pub(crate) overwrite: bool,
    /// Also list every defect of the extract and every road lost, one per line (CSV); an existing list is kept
    /// unless -O is given
    #[arg(long, value_name = "CSV", requires = "osm")]
    pub(crate) defects: Option<PathBuf>,
    /// Credit to show wherever the package is shown, such as a DEM's; may be given several times
    #[arg(long, value_name = "TEXT")]
    pub(crate) attribution: Vec<String>,
    /// Settings file; what is said on the command line goes before it
    #[arg(long, value_name = "TOML")]
    pub(crate) config: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) terrain: TerrainOptions,
    #[command(flatten)]
    pub(crate) roads: RoadOptions,
    #[command(flatten)]
    pub(crate) resources: ResourceOptions,
    #[command(flatten)]
    pub(crate) report: ReportArgs,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Progress")]
pub(crate) struct ReportArgs {
    /// Say nothing but errors and warnings
    #[arg(short, long, conflicts_with = "json_progress")]
    pub(crate) quiet: bool,
    /// Progress as one JSON object a line on standard error
    #[arg(long)]
    pub(crate) json_progress: bool,
}
