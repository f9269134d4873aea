//! Arguments of `profile`: the ways or lines to follow, and the files to write.

use std::path::PathBuf;

use clap::{ArgGroup, Args};

use super::{
    shared::{ClassesArg, ExtractArgs, LevelArg, RecordedArgs, RoadArg, ThreadsArg},
    values::parse_position,
};
use crate::failure::Result;

#[derive(Debug, Args)]
#[command(
    group = ArgGroup::new("drawn").args(["csv", "json", "svg"]).multiple(true),
    group = ArgGroup::new("what").args(["way", "line", "reference", "name", "from"]).required(true).multiple(true),
    override_usage = "corniche profile [OPTIONS] <--way <ID>|--line <FILE>|--ref <NUMBER>|--name <NAME>|--from <LON,LAT> --to <LON,LAT>> <PACKAGE>",
    mut_arg("dem", |arg| arg.help("The DEM the package was built from (same files, same order): heights are read from it, and grades are computed along a smoothed line")),
    mut_arg("osm", |arg| arg.help("The extracts the package was built from: with --dem, bridges and tunnels get heights, and grades are computed from junction to junction; with --ref, --name or --from, roads join at the nodes that they share")),
    mut_arg("level", |arg| arg.help("The level whose terrain is followed [default: the finest]")),
    mut_arg("reference", |arg| arg.conflicts_with_all(["way", "line"]).help("Follow the road with this number (OSM's ref), such as \"CG 2\", from end to end; spaces, hyphens and case are ignored")),
    mut_arg("name", |arg| arg.conflicts_with_all(["way", "line"]).help("Follow the road with this name (OSM's name), from end to end; spaces, hyphens and case are ignored")),
    mut_arg("classes", |arg| arg.conflicts_with_all(["way", "line"]).help("With --ref, --name or --from: functional road classes (FRC) to follow, such as 0-5")),
)]
pub(crate) struct ProfileArgs {
    #[command(flatten)]
    pub recorded: RecordedArgs,
    #[command(flatten)]
    pub extract: ExtractArgs,
    /// Follow these ways, by their OSM ids, in this order; each is turned so that it continues
    /// where the previous one ends
    #[arg(long, value_name = "ID", value_delimiter = ',', allow_negative_numbers = true)]
    pub way: Vec<i64>,
    /// Follow the lines of a file (GeoJSON, GPX, GeoPackage, Shapefile …), one after the other
    #[arg(long, value_name = "FILE", conflicts_with = "way")]
    pub line: Option<PathBuf>,
    #[command(flatten)]
    pub road: RoadArg,
    /// Follow the shortest way along roads from this longitude and latitude; with --ref or --name,
    /// along that road
    #[arg(long, value_name = "LON,LAT", requires = "to", conflicts_with_all = ["way", "line"], allow_hyphen_values = true, value_parser = parse_position)]
    from: Option<[f64; 2]>,
    /// With --from: longitude and latitude of the destination
    #[arg(long, value_name = "LON,LAT", requires = "from", allow_hyphen_values = true, value_parser = parse_position)]
    to: Option<[f64; 2]>,
    #[command(flatten)]
    pub filter: ClassesArg,
    /// Allow PROJ's ballpark transformations (no datum shift) for the file of --line; its lines can
    /// then be off by 100 m or more
    #[arg(long, requires = "line")]
    pub allow_ballpark: bool,
    #[command(flatten)]
    pub at: LevelArg,
    #[command(flatten)]
    pub cpu: ThreadsArg,
    /// Also write one line per vertex (CSV)
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Also write the whole profile for programs (JSON)
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Also draw height and grade over distance (SVG)
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Overwrite existing files, once the new ones are complete
    #[arg(short = 'O', long, requires = "drawn")]
    pub overwrite: bool,
}

impl ProfileArgs {
    /// Longitude and latitude of both ends, where they are given.
    pub(crate) fn ends_deg(&self) -> Option<[[f64; 2]; 2]> {
        self.from.zip(self.to).map(|(from, to)| [from, to])
    }

    /// Whether roads are searched by number or name, or from place to place.
    pub(crate) fn is_route(&self) -> bool {
        self.from.is_some() || self.road.query().is_some()
    }

    /// Rejects an extract that would have no effect.
    ///
    /// # Errors
    /// When --osm is given without --dem, and no road is searched.
    pub(crate) fn refuse_idle_extract(&self, dem: &[PathBuf], osm: &[PathBuf]) -> Result<()> {
        if osm.is_empty() || !dem.is_empty() || self.is_route() {
            return Ok(());
        }
        Err(unusable!("--osm has no effect without --dem; also pass the DEM"))
    }
}
