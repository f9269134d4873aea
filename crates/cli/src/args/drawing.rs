//! Commands that render images: one image, or a flight of them.

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
    pub from: PackageArg,
    /// The image to write (.png), or with --ortho a GeoTIFF with its georeference (.tif)
    #[arg(short, long, value_name = "PNG|TIF")]
    pub output: PathBuf,
    /// Overwrite existing files, once the new ones are complete
    #[arg(short = 'O', long)]
    pub overwrite: bool,
    /// How roads are drawn
    #[arg(long, value_parser = Roads::one_method(), default_value = Roads::DEFAULT.word())]
    pub roads: Roads,
    #[command(flatten)]
    pub look: LookArgs,
    /// Width and height in pixels
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1600x1200", value_parser = parse_size)]
    pub size: [u32; 2],
    #[command(flatten)]
    pub camera: CameraArgs,
    #[command(flatten)]
    pub from_above: FromAboveArgs,
    #[command(flatten)]
    pub ground: GroundArgs,
    /// Samples per pixel along each side, averaged
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=4))]
    pub supersampling: u32,
    /// Draw a legend: the roads, tunnels, boundaries, areas and heights in the image, a north
    /// arrow, and a scale bar for its centre
    #[arg(long)]
    pub legend: bool,
    /// Write a title in the upper left corner of the image
    #[arg(long, value_name = "TEXT", value_parser = parse_title, allow_hyphen_values = true)]
    pub title: Option<String>,
    /// Draw the edges of the terrain's triangles, beneath the roads
    #[arg(long)]
    pub wireframe: bool,
    /// Do not drape roads on the ground: with --roads geo, draw straight lines between their
    /// points, which the ground may hide
    #[arg(long, help_heading = COMPARING, hide_short_help = true)]
    pub unmapped: bool,
}

/// The values of `--lod`.
pub(crate) const DETAILS: Words<Detail, 3> = [
    ("full", "All tiles of the finest level, in view or not", Detail::Full),
    ("culled", "The tiles of the finest level that are in view", Detail::Culled),
    ("lod", "Tiles by screen-space error, loaded during the flight", Detail::Adaptive),
];

#[derive(Debug, Args)]
pub(crate) struct FlyArgs {
    #[command(flatten)]
    pub from: PackageArg,
    /// The table to write (.csv): one line per frame, with its tiles, triangles, bytes and
    /// milliseconds
    #[arg(short, long, value_name = "CSV")]
    pub output: PathBuf,
    /// Overwrite existing files, once the new ones are complete
    #[arg(short = 'O', long)]
    pub overwrite: bool,
    /// Also draw a chart of frame times, road segments and tiles along the flight
    #[arg(long, value_name = "SVG")]
    pub svg: Option<PathBuf>,
    /// Also save every frame as an image in this new folder
    #[arg(long, value_name = "FOLDER")]
    pub png: Option<PathBuf>,
    /// Also show every frame in a window; closing it, or Ctrl Q, ends the flight
    #[arg(long)]
    pub window: bool,
    #[command(flatten)]
    pub flight: FlightArgs,
    #[command(flatten)]
    pub drawing: DrawingArgs,
    #[command(flatten)]
    pub look: LookArgs,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Flight")]
pub(crate) struct FlightArgs {
    /// Flight path: keyframes in TOML, as --save-path writes them [default: a pass along the data]
    #[arg(long, value_name = "TOML")]
    pub path: Option<PathBuf>,
    /// Save the flight path in this file, as keyframes in TOML
    #[arg(long, value_name = "TOML")]
    pub save_path: Option<PathBuf>,
    /// Number of frames, evenly spaced along the flight
    #[arg(long, value_name = "N", default_value_t = 100)]
    pub frames: u32,
    /// Time between frames, in seconds, instead of a number of frames
    #[arg(long, value_name = "SECONDS", conflicts_with = "frames", allow_negative_numbers = true)]
    pub step: Option<f64>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Drawing")]
pub(crate) struct DrawingArgs {
    /// How roads are drawn; with several values, separated by commas, the flight is repeated with
    /// each
    #[arg(long, value_parser = one_of(ROADS), value_delimiter = ',', default_value = Roads::DEFAULT.word())]
    pub roads: Vec<Roads>,
    /// How much of the ground is drawn; with several values, the flight is repeated with each
    #[arg(long, value_parser = one_of(DETAILS), value_delimiter = ',', default_value = "lod")]
    pub lod: Vec<Detail>,
    /// Width and height in pixels
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1600x1200", value_parser = parse_size)]
    pub size: [u32; 2],
    #[command(flatten)]
    pub ground: GroundArgs,
    /// Samples per pixel along each side, averaged. The default is 1, unlike for images, so that
    /// the cost of a frame can be compared with published figures
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=4))]
    pub supersampling: u32,
    #[command(flatten)]
    pub gpu: GpuArgs,
    /// Preload tiles for the camera position this many seconds ahead; 0 turns preloading off
    #[arg(long, value_name = "SECONDS", default_value_t = 1.0)]
    pub ahead: f64,
}

#[cfg(test)]
#[path = "drawing_tests.rs"]
mod tests;
