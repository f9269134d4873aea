//! Arguments of `profile`: the ways or lines to follow, and what to write of them.

use std::path::PathBuf;

use clap::{ArgGroup, Args};

use super::shared::{ExtractArgs, LevelArg, RecordedArgs, ThreadsArg};

#[derive(Debug, Args)]
#[command(
    group = ArgGroup::new("drawn").args(["csv", "svg"]).multiple(true),
    group = ArgGroup::new("what").args(["way", "line"]).required(true),
    override_usage = "corniche profile [OPTIONS] <--way <ID>|--line <FILE>> <PACKAGE>",
    mut_arg("dem", |arg| arg.help("The elevation rasters the package was made from, in the same order: heights are theirs, and grades those of a smooth line")),
    mut_arg("osm", |arg| arg.requires("dem")),
    mut_arg("level", |arg| arg.help("The level on whose ground they lie [default: the finest]")),
)]
pub(crate) struct ProfileArgs {
    #[command(flatten)]
    pub(crate) from: RecordedArgs,
    #[command(flatten)]
    pub(crate) extract: ExtractArgs,
    /// The ways to follow, by their ids in OSM, in this order; each is turned so that it goes on where the one before it ends
    #[arg(long, value_name = "ID", value_delimiter = ',', allow_negative_numbers = true)]
    pub(crate) way: Vec<i64>,
    /// The lines to follow instead: those of a file (GeoJSON, GPX, GeoPackage, Shapefile …), one after the other
    #[arg(long, value_name = "FILE")]
    pub(crate) line: Option<PathBuf>,
    /// Take the datum of that file for that of WGS84 where PROJ knows nothing between them; its lines can then lie 100 m and more beside the ground
    #[arg(long, requires = "line")]
    pub(crate) allow_ballpark: bool,
    #[command(flatten)]
    pub(crate) at: LevelArg,
    #[command(flatten)]
    pub(crate) cpu: ThreadsArg,
    /// Also write a line for each vertex (CSV)
    #[arg(long, value_name = "FILE")]
    pub(crate) csv: Option<PathBuf>,
    /// Also draw height and grade over distance (SVG)
    #[arg(long, value_name = "FILE")]
    pub(crate) svg: Option<PathBuf>,
    /// Replace files that exist, once the new ones are complete
    #[arg(short = 'O', long, requires = "drawn")]
    pub(crate) overwrite: bool,
}
