//! What can be said on the command line.

use std::{num::NonZeroUsize, path::PathBuf};

use clap::{Args, Parser, Subcommand, ValueEnum};
use corniche_geom::TileId;
use corniche_viewer::RoadMethod;

/// Terrain tiles with roads laid exactly on them, from elevation rasters and OpenStreetMap extracts.
#[derive(Debug, Parser)]
#[command(version, name = "corniche", max_term_width = 100)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Build a tile package from elevation rasters and an OpenStreetMap extract
    Build(Box<BuildArgs>),
    /// Tell what a package holds and what became of its inputs
    Info(InfoArgs),
    /// Tell what laying roads on the terrain costs, per level and class
    Growth(GrowthArgs),
    /// Check every promise a package makes; exits with 1 when one is broken
    Verify(VerifyArgs),
    /// Dump one decoded tile
    Tile(TileArgs),
    /// Draw a package to a PNG, without a window
    Render(RenderArgs),
    /// Fly over a package without a window and tell what each frame costs
    Fly(FlyArgs),
}

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
    /// Replace the package if it exists, once the new one is complete
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
    /// Working CRS, projected, in metres [default: the DEM's if it is projected and true to scale, else UTM]
    #[arg(long, value_name = "EPSG:N")]
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
    /// Height that means "no data", beside what the files say
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true)]
    pub(crate) nodata: Option<f64>,
    /// Spacing of the finest level, in metres [default: the DEM's]
    #[arg(long, value_name = "METRES", allow_negative_numbers = true)]
    pub(crate) cell: Option<f64>,
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
    /// Memory for buffers and caches, such as 512M or 4G [default: 1G]
    #[arg(long, value_name = "BYTES")]
    pub(crate) memory: Option<String>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Progress")]
pub(crate) struct ReportArgs {
    /// Say nothing but errors
    #[arg(short, long, conflicts_with = "json_progress")]
    pub(crate) quiet: bool,
    /// Progress as one JSON object a line on standard error
    #[arg(long)]
    pub(crate) json_progress: bool,
}

#[derive(Debug, Args)]
pub(crate) struct InfoArgs {
    /// The package
    pub(crate) package: PathBuf,
    /// For programs
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct GrowthArgs {
    /// The package
    pub(crate) package: PathBuf,
    /// For programs: JSON
    #[arg(long, conflicts_with = "csv")]
    pub(crate) json: bool,
    /// For programs: CSV
    #[arg(long)]
    pub(crate) csv: bool,
    /// Also draw the growth per level and class
    #[arg(long, value_name = "FILE")]
    pub(crate) svg: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct VerifyArgs {
    /// The package
    pub(crate) package: PathBuf,
    /// The elevation rasters it was made from, in the same order: checks stored errors against true ones
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub(crate) dem: Vec<PathBuf>,
    /// Worker threads [default: one per processor]
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,
    /// For programs
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) report: ReportArgs,
}

#[derive(Debug, Args)]
pub(crate) struct TileArgs {
    /// The package
    pub(crate) package: PathBuf,
    /// The tile: level, column from the west, row from the north
    #[arg(value_name = "Z/X/Y")]
    pub(crate) id: TileId,
    /// For programs: everything, in working-CRS coordinates
    #[arg(long)]
    pub(crate) json: bool,
}

/// How roads are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Roads {
    /// As geometry on the TIN
    Geo,
    /// As shadow volumes: exact to the pixel, also on steep ground
    Sv,
    /// Not at all
    None,
}

impl Roads {
    /// As it is said on the command line.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Geo => "geo",
            Self::Sv => "sv",
            Self::None => "none",
        }
    }
}

impl From<Roads> for RoadMethod {
    fn from(roads: Roads) -> Self {
        match roads {
            Roads::Geo => Self::Geometry,
            Roads::Sv => Self::ShadowVolumes,
            Roads::None => Self::None,
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    /// The package
    pub(crate) package: PathBuf,
    /// The picture to write (.png); an existing one is replaced
    #[arg(short, long, value_name = "PNG")]
    pub(crate) output: PathBuf,
    /// How roads are drawn
    #[arg(long, value_enum, default_value_t = Roads::Geo)]
    pub(crate) roads: Roads,
    /// Width and height in pixels
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1600x1200", value_parser = parse_size)]
    pub(crate) size: [u32; 2],
    /// Look at this longitude and latitude (degrees, WGS84) instead of the whole package
    #[arg(long, value_name = "LON,LAT", value_parser = parse_position, allow_hyphen_values = true)]
    pub(crate) look_at: Option<[f64; 2]>,
    /// Distance from the eye to the point looked at, in metres
    #[arg(long, value_name = "METRES", default_value_t = 5000.0, requires = "look_at")]
    pub(crate) distance: f64,
    /// Direction of view, in degrees clockwise from north
    #[arg(
        long,
        value_name = "DEGREES",
        default_value_t = 0.0,
        requires = "look_at",
        allow_hyphen_values = true
    )]
    pub(crate) heading: f64,
    /// Tilt of the view, in degrees: 0 looks straight down, 90 at the horizon
    #[arg(long, value_name = "DEGREES", default_value_t = 60.0, requires = "look_at")]
    pub(crate) pitch: f64,
    /// Terrain error that may be seen, in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 2.0)]
    pub(crate) screen_space_error: f64,
    /// Vertical exaggeration
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    pub(crate) exaggeration: f64,
}

/// How much of the ground is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Lod {
    /// All finest tiles, in view or not
    Full,
    /// The finest tiles in view
    Culled,
    /// Tiles by screen-space error, loaded on the way
    #[value(name = "lod")]
    Adaptive,
}

impl Lod {
    /// As it is said on the command line.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Full => "full",
            Self::Culled => "culled",
            Self::Adaptive => "lod",
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct FlyArgs {
    /// The package
    pub(crate) package: PathBuf,
    /// The list to write (.csv): one line per frame, with the tiles, triangles, bytes and milliseconds it took
    #[arg(short, long, value_name = "CSV")]
    pub(crate) output: PathBuf,
    /// Replace files that exist, once the new ones are complete
    #[arg(short = 'O', long)]
    pub(crate) overwrite: bool,
    /// Also draw the frame times along the flight
    #[arg(long, value_name = "SVG")]
    pub(crate) svg: Option<PathBuf>,
    /// Also keep every frame as a picture in this new folder
    #[arg(long, value_name = "FOLDER")]
    pub(crate) png: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) flight: FlightArgs,
    #[command(flatten)]
    pub(crate) drawing: DrawingArgs,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Flight")]
pub(crate) struct FlightArgs {
    /// Flight to take: keyframes in TOML, as --save-path writes them [default: a pass along the data]
    #[arg(long, value_name = "TOML")]
    pub(crate) path: Option<PathBuf>,
    /// Write down the flight taken
    #[arg(long, value_name = "TOML")]
    pub(crate) save_path: Option<PathBuf>,
    /// How many frames, evenly spread over the flight
    #[arg(long, value_name = "N", default_value_t = 100)]
    pub(crate) frames: u32,
    /// Time from one frame to the next, in seconds, instead of a number of frames
    #[arg(long, value_name = "SECONDS", conflicts_with = "frames", allow_negative_numbers = true)]
    pub(crate) step: Option<f64>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Drawing")]
pub(crate) struct DrawingArgs {
    /// How roads are drawn; with several, separated by commas, the flight is taken with each
    #[arg(long, value_enum, value_delimiter = ',', default_value = "geo")]
    pub(crate) roads: Vec<Roads>,
    /// How much of the ground is drawn; with several, the flight is taken with each
    #[arg(long, value_enum, value_delimiter = ',', default_value = "lod")]
    pub(crate) lod: Vec<Lod>,
    /// Width and height in pixels
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1600x1200", value_parser = parse_size)]
    pub(crate) size: [u32; 2],
    /// Terrain error that may be seen, in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 2.0)]
    pub(crate) screen_space_error: f64,
    /// Vertical exaggeration
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    pub(crate) exaggeration: f64,
    /// Memory for tiles on the graphics card, such as 512M or 4G
    #[arg(long, value_name = "BYTES", default_value = "512M", value_parser = parse_bytes)]
    pub(crate) gpu_memory: u64,
    /// Handed to the graphics card in a frame at most, though always a whole tile
    #[arg(long, value_name = "BYTES", default_value = "4M", value_parser = parse_bytes)]
    pub(crate) upload_per_frame: u64,
    /// Load for where the camera will be in so many seconds; 0 loads nothing in advance
    #[arg(long, value_name = "SECONDS", default_value_t = 1.0)]
    pub(crate) ahead: f64,
}

fn parse_bytes(text: &str) -> Result<u64, String> {
    let (digits, shift) = match text.strip_suffix(['K', 'M', 'G']) {
        Some(digits) if text.ends_with('K') => (digits, 10),
        Some(digits) if text.ends_with('M') => (digits, 20),
        Some(digits) => (digits, 30),
        None => (text, 0),
    };
    let number: Option<u64> = digits.parse().ok();
    match number.and_then(|number| number.checked_mul(1 << shift)) {
        Some(size_bytes @ 1..) => Ok(size_bytes),
        _ => Err("write it like 800K, 512M or 4G".to_owned()),
    }
}

fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let sides = text
        .split_once('x')
        .and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
    match sides {
        Some([width @ 1..=8192, height @ 1..=8192]) => Ok([width, height]),
        Some(_) => Err("both sides must be between 1 and 8192 pixels".to_owned()),
        None => Err("write it like 1600x1200".to_owned()),
    }
}

fn parse_position(text: &str) -> Result<[f64; 2], String> {
    let position = text
        .split_once(',')
        .and_then(|(lon, lat)| Some([lon.trim().parse().ok()?, lat.trim().parse().ok()?]));
    match position {
        Some([lon, lat]) if (-360.0..=360.0).contains(&lon) && (-90.0..=90.0).contains(&lat) => {
            Ok([lon, lat])
        }
        Some(_) => Err("longitude must be within ±360 and latitude within ±90 degrees".to_owned()),
        None => Err("write longitude,latitude like 9.52,47.14".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        use clap::CommandFactory as _;
        Arguments::command().debug_assert();
    }

    #[test]
    fn sizes_of_memory() {
        assert_eq!(parse_bytes("800K"), Ok(800 << 10));
        assert_eq!(parse_bytes("512M"), Ok(512 << 20));
        assert_eq!(parse_bytes("4G"), Ok(4 << 30));
        assert_eq!(parse_bytes("17"), Ok(17));
        for bad in ["", "0", "M", "-1M", "4T", "1.5G", "99999999999999G"] {
            assert!(parse_bytes(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn one_flight_may_be_taken_with_several_methods() {
        let line = "corniche fly a -o b --roads none,geo --roads sv --lod full,culled,lod";
        let Command::Fly(args) = Arguments::try_parse_from(line.split(' ')).unwrap().command else {
            panic!("{line} is a flight");
        };
        assert_eq!(args.drawing.roads, [Roads::None, Roads::Geo, Roads::Sv]);
        assert_eq!(args.drawing.lod, [Lod::Full, Lod::Culled, Lod::Adaptive]);
        let both = "corniche fly a -o b --frames 3 --step 0.1";
        assert!(Arguments::try_parse_from(both.split(' ')).is_err());
    }

    #[test]
    fn sizes_and_positions() {
        assert_eq!(parse_size("640x480"), Ok([640, 480]));
        assert!(
            parse_size("640").is_err()
                && parse_size("0x5").is_err()
                && parse_size("9000x9000").is_err()
        );
        assert_eq!(parse_position("-9.5, 47"), Ok([-9.5, 47.0]));
        assert!(parse_position("47").is_err() && parse_position("9,147").is_err());
    }

    #[test]
    fn options_of_later_issues_are_rejected() {
        for line in ["--resume", "--photo x.tif"] {
            let line = format!("corniche build --dem a.tif -o b {line}");
            assert!(Arguments::try_parse_from(line.split(' ')).is_err(), "{line}");
        }
    }
}
