//! Commands that draw pictures: one, or a flight of them.

use std::path::PathBuf;

use clap::Args;
use corniche_presets::{Words, one_of};
use corniche_viewer::Detail;

use super::{
    camera::{CameraArgs, FromAboveArgs},
    ground::GroundArgs,
    look::{COMPARING, LookArgs, ROADS, Roads},
    shared::{GpuArgs, PackageArg},
    values::{parse_size, parse_title},
};

#[derive(Debug, Args)]
#[expect(clippy::struct_excessive_bools, reason = "switches of the command line")]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    pub(crate) from: PackageArg,
    /// The picture to write (.png), or with --ortho a GeoTIFF that knows its place (.tif)
    #[arg(short, long, value_name = "PNG|TIF")]
    pub(crate) output: PathBuf,
    /// Replace files that exist, once the new ones are complete
    #[arg(short = 'O', long)]
    pub(crate) overwrite: bool,
    /// How roads are drawn
    #[arg(long, value_parser = Roads::one_method(), default_value = Roads::DEFAULT.word())]
    pub(crate) roads: Roads,
    #[command(flatten)]
    pub(crate) look: LookArgs,
    /// Width and height in pixels
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1600x1200", value_parser = parse_size)]
    pub(crate) size: [u32; 2],
    #[command(flatten)]
    pub(crate) camera: CameraArgs,
    #[command(flatten)]
    pub(crate) from_above: FromAboveArgs,
    #[command(flatten)]
    pub(crate) ground: GroundArgs,
    /// Samples per pixel along each side, averaged
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=4))]
    pub(crate) supersampling: u32,
    /// Draw a legend: the roads, tunnels, boundaries, areas and heights that the picture shows, an arrow to the north, and a scale for its middle
    #[arg(long)]
    pub(crate) legend: bool,
    /// Write a title on the picture, at its upper left
    #[arg(long, value_name = "TEXT", value_parser = parse_title, allow_hyphen_values = true)]
    pub(crate) title: Option<String>,
    /// Draw the edges of the ground's triangles, beneath the roads
    #[arg(long)]
    pub(crate) wireframe: bool,
    /// Lay no road on the ground: with --roads geo, straight lines between their points, which ground hides
    #[arg(long, help_heading = COMPARING, hide_short_help = true)]
    pub(crate) unmapped: bool,
}

/// How much of the ground is drawn.
pub(crate) const DETAILS: Words<Detail, 3> = [
    ("full", "All finest tiles, in view or not", Detail::Full),
    ("culled", "The finest tiles in view", Detail::Culled),
    ("lod", "Tiles by screen-space error, loaded on the way", Detail::Adaptive),
];

#[derive(Debug, Args)]
pub(crate) struct FlyArgs {
    #[command(flatten)]
    pub(crate) from: PackageArg,
    /// The list to write (.csv): one line per frame, with the tiles, triangles, bytes and milliseconds it took
    #[arg(short, long, value_name = "CSV")]
    pub(crate) output: PathBuf,
    /// Replace files that exist, once the new ones are complete
    #[arg(short = 'O', long)]
    pub(crate) overwrite: bool,
    /// Also draw a chart of frame times, road segments and tiles along the flight
    #[arg(long, value_name = "SVG")]
    pub(crate) svg: Option<PathBuf>,
    /// Also keep every frame as a picture in this new folder
    #[arg(long, value_name = "FOLDER")]
    pub(crate) png: Option<PathBuf>,
    /// Also show every frame in a window as it is drawn; closing it, also with Ctrl Q, ends the flight
    #[arg(long)]
    pub(crate) window: bool,
    #[command(flatten)]
    pub(crate) flight: FlightArgs,
    #[command(flatten)]
    pub(crate) drawing: DrawingArgs,
    #[command(flatten)]
    pub(crate) look: LookArgs,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Flight")]
pub(crate) struct FlightArgs {
    /// Flight to take: keyframes in TOML, as --save-path writes them [default: a pass along the data]
    #[arg(long, value_name = "TOML")]
    pub(crate) path: Option<PathBuf>,
    /// Save the flight in this file, as keyframes in TOML
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
    #[arg(long, value_parser = one_of(ROADS), value_delimiter = ',', default_value = Roads::DEFAULT.word())]
    pub(crate) roads: Vec<Roads>,
    /// How much of the ground is drawn; with several, the flight is taken with each
    #[arg(long, value_parser = one_of(DETAILS), value_delimiter = ',', default_value = "lod")]
    pub(crate) lod: Vec<Detail>,
    /// Width and height in pixels
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1600x1200", value_parser = parse_size)]
    pub(crate) size: [u32; 2],
    #[command(flatten)]
    pub(crate) ground: GroundArgs,
    /// Samples per pixel along each side, averaged. One by default, other than for pictures: what a frame costs is compared with published
    /// figures, which have one
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=4))]
    pub(crate) supersampling: u32,
    #[command(flatten)]
    pub(crate) gpu: GpuArgs,
    /// Load for where the camera will be in so many seconds; 0 loads nothing in advance
    #[arg(long, value_name = "SECONDS", default_value_t = 1.0)]
    pub(crate) ahead: f64,
}

#[cfg(test)]
#[path = "drawing_tests.rs"]
mod tests;
