use std::{num::NonZeroUsize, path::PathBuf};

use clap::Args;

use super::values::{parse_cell, parse_range};

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
    pub(crate) terrain: TerrainArgs,
    #[command(flatten)]
    pub(crate) roads: RoadArgs,
    #[command(flatten)]
    pub(crate) resources: ResourceArgs,
    #[command(flatten)]
    pub(crate) report: ReportArgs,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Terrain")]
pub(crate) struct TerrainArgs {
    /// Working CRS: dem (the first raster's own, so that nodes are its samples), utm, or any projected one
    /// [default: dem where lengths are then true within 3 %, else utm]
    #[arg(long, value_name = "dem|utm|EPSG:N|WKT")]
    pub(crate) crs: Option<String>,
    /// CRS of rasters that name none
    #[arg(long, value_name = "EPSG:N")]
    pub(crate) dem_crs: Option<String>,
    /// Vertical CRS of rasters that name none
    #[arg(long, value_name = "EPSG:N")]
    pub(crate) dem_vertical_crs: Option<String>,
    /// Vertical CRS that heights are wanted in, through PROJ and its geoid grids [default: the files']
    #[arg(long, value_name = "EPSG:N")]
    pub(crate) vertical_crs: Option<String>,
    /// Added to every height, in metres [default: 0]
    #[arg(long, value_name = "METRES", allow_negative_numbers = true)]
    pub(crate) vertical_shift: Option<f64>,
    /// Value that means "no data" as the files store it, beside what they say themselves; may be given several times
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true)]
    pub(crate) nodata: Vec<f64>,
    /// Heights that samples may have, in metres, before --vertical-shift; what lies in it is believed, however odd
    /// [default: -12000,9000, and no repeated value 1000 m beyond all others]
    #[arg(long, value_name = "LOW,HIGH", value_parser = parse_range, allow_hyphen_values = true)]
    pub(crate) height_range: Option<[f64; 2]>,
    /// Latitude, in degrees, at which lengths are true in a CRS that is not true to scale, such as degrees; packages of
    /// adjoining regions fit when it is the same [default: the middle of the DEM, to half a degree]
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true)]
    pub(crate) scale_latitude: Option<f64>,
    /// Spacing of the finest level, in metres: of a square, or of a rectangle, east and north; heights are interpolated
    /// [default: the DEM's own]
    #[arg(long, value_name = "METRES|EAST,NORTH", value_parser = parse_cell, allow_hyphen_values = true)]
    pub(crate) cell: Option<[f64; 2]>,
    /// Take one in K of the DEM's samples along both axes as the finest level, as they are
    #[arg(long, value_name = "K", conflicts_with = "cell")]
    pub(crate) cell_every: Option<u32>,
    /// Build with more than 16 nodes to a DEM sample, too
    #[arg(long)]
    pub(crate) force: bool,
    /// Largest vertical error of the finest level, in metres [default: a quarter of the cell]
    #[arg(long, value_name = "METRES", allow_negative_numbers = true)]
    pub(crate) max_error: Option<f64>,
    /// Fill voids that have data within this many cells in each of eight directions [default: 32]
    #[arg(long, value_name = "CELLS")]
    pub(crate) fill_voids: Option<u32>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Roads")]
pub(crate) struct RoadArgs {
    /// FRC table: a preset (default, valhalla, fraunhofer, itinero, here5) or a TOML file [default: default]
    #[arg(long, value_name = "PRESET|FILE")]
    pub(crate) frc_table: Option<String>,
    /// Show every class on every level
    #[arg(long)]
    pub(crate) all_classes: bool,
    /// Tolerance of the simplification of roads on coarser levels, in cells of the level; 0 keeps every point
    /// [default: 0.25]
    #[arg(long, value_name = "CELLS")]
    pub(crate) simplify: Option<f64>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Resources")]
pub(crate) struct ResourceArgs {
    /// Worker threads [default: one per processor]
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,
    /// Memory for buffers and caches, such as 512M, 4G or 1T [default: 1G]
    #[arg(long, value_name = "BYTES")]
    pub(crate) memory: Option<String>,
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
