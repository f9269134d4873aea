//! Arguments of `profile`: the ways or lines to follow, and what to write of them.

use std::path::PathBuf;

use clap::{ArgGroup, Args};

use super::{
    shared::{ClassesArg, ExtractArgs, LevelArg, RecordedArgs, RoadArg, ThreadsArg},
    values::parse_position,
};
use crate::failure::Failure;

#[derive(Debug, Args)]
#[command(
    group = ArgGroup::new("drawn").args(["csv", "json", "svg"]).multiple(true),
    group = ArgGroup::new("what").args(["way", "line", "reference", "name", "from"]).required(true).multiple(true),
    override_usage = "corniche profile [OPTIONS] <--way <ID>|--line <FILE>|--ref <NUMBER>|--name <NAME>|--from <LON,LAT> --to <LON,LAT>> <PACKAGE>",
    mut_arg("dem", |arg| arg.help("The elevation rasters the package was made from, in the same order: heights are theirs, and grades those of a smooth line")),
    mut_arg("osm", |arg| arg.help("The extracts the package was made from: with --dem, bridges and tunnels get heights, and grades are those from junction to junction; with --ref, --name or --from, roads join where they name the same node")),
    mut_arg("level", |arg| arg.help("The level on whose ground they lie [default: the finest]")),
    mut_arg("reference", |arg| arg.conflicts_with_all(["way", "line"]).help("The road with this number (OSM's ref), such as \"CG 2\", from end to end; spaces, hyphens and case do not matter")),
    mut_arg("name", |arg| arg.conflicts_with_all(["way", "line"]).help("The road with this name (OSM's name), from end to end; spaces, hyphens and case do not matter")),
    mut_arg("classes", |arg| arg.conflicts_with_all(["way", "line"]).help("With --ref, --name or --from: functional road classes that are followed, such as 0-5")),
)]
pub(crate) struct ProfileArgs {
    #[command(flatten)]
    pub(crate) recorded: RecordedArgs,
    #[command(flatten)]
    pub(crate) extract: ExtractArgs,
    /// The ways to follow, by their ids in OSM, in this order; each is turned so that it goes on where the one before it ends
    #[arg(long, value_name = "ID", value_delimiter = ',', allow_negative_numbers = true)]
    pub(crate) way: Vec<i64>,
    /// The lines to follow instead: those of a file (GeoJSON, GPX, GeoPackage, Shapefile …), one after the other
    #[arg(long, value_name = "FILE", conflicts_with = "way")]
    pub(crate) line: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) road: RoadArg,
    /// The shortest way along roads from here, longitude and latitude; with --ref or --name along that road
    #[arg(long, value_name = "LON,LAT", requires = "to", conflicts_with_all = ["way", "line"], allow_hyphen_values = true, value_parser = parse_position)]
    from: Option<[f64; 2]>,
    /// With --from: where it ends
    #[arg(long, value_name = "LON,LAT", requires = "from", allow_hyphen_values = true, value_parser = parse_position)]
    to: Option<[f64; 2]>,
    #[command(flatten)]
    pub(crate) filter: ClassesArg,
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
    /// Also write all of it for programs (JSON)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    /// Also draw height and grade over distance (SVG)
    #[arg(long, value_name = "FILE")]
    pub(crate) svg: Option<PathBuf>,
    /// Replace files that exist, once the new ones are complete
    #[arg(short = 'O', long, requires = "drawn")]
    pub(crate) overwrite: bool,
}

impl ProfileArgs {
    /// Longitude and latitude of both ends, where they are given.
    pub(crate) fn ends_deg(&self) -> Option<[[f64; 2]; 2]> {
        self.from.zip(self.to).map(|(from, to)| [from, to])
    }

    /// Whether roads are looked for, by their numbers or names, or from place to place.
    pub(crate) fn is_route(&self) -> bool {
        self.from.is_some() || self.road.query().is_some()
    }

    /// Refuses an extract that nothing is read from.
    ///
    /// # Errors
    /// When --osm is given without --dem, and no road is looked for.
    pub(crate) fn refuse_idle_extract(
        &self,
        dem: &[PathBuf],
        osm: &[PathBuf],
    ) -> Result<(), Failure> {
        if osm.is_empty() || !dem.is_empty() || self.is_route() {
            return Ok(());
        }
        Err(Failure::unusable("--osm changes nothing without --dem; give the elevation files, too"))
    }
}
