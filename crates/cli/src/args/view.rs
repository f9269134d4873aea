//! The command that opens a window.

use std::path::PathBuf;

use clap::{ArgAction, Args};
use corniche_presets::{Words, one_of};

use super::{
    camera::CameraArgs,
    ground::GroundArgs,
    look::{LookArgs, Roads},
    shared::{GpuArgs, PackageArg},
    values::parse_size,
};

/// How camera movements end.
const MOTIONS: Words<bool, 2> =
    [("soft", "Slow down smoothly", true), ("prompt", "Stop at once", false)];

#[derive(Debug, Args)]
pub(crate) struct ViewArgs {
    #[command(flatten)]
    pub from: PackageArg,
    /// How roads are drawn at first [default: sv; geo without a GPU, because sv is slow there]
    #[arg(long, value_parser = Roads::one_method())]
    pub roads: Option<Roads>,
    #[command(flatten)]
    pub look: LookArgs,
    /// Initial width and height of the window, in pixels. The default is smaller than for images,
    /// so that it fits on a screen
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1280x800", value_parser = parse_size)]
    pub size: [u32; 2],
    #[command(flatten)]
    pub camera: CameraArgs,
    #[command(flatten)]
    pub ground: GroundArgs,
    /// Samples per pixel along each side, averaged [default: 2; 1 without a GPU, because more is
    /// too slow for navigation]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4))]
    pub supersampling: Option<u32>,
    #[command(flatten)]
    pub gpu: GpuArgs,
    /// How camera movements end
    #[arg(long, value_parser = one_of(MOTIONS), default_value = "soft", action = ArgAction::Set)]
    pub motion: bool,
    /// Lines to edit with the mouse (key L): a GeoJSON file, created if it does not exist. They are
    /// saved with Ctrl S and at the end [default: a new file in --folder]
    #[arg(long, value_name = "GEOJSON")]
    pub draw: Option<PathBuf>,
    /// Folder for images (key P) and recorded flights (key C), which are numbered; no file is
    /// overwritten
    #[arg(long, value_name = "FOLDER", default_value = ".")]
    pub folder: PathBuf,
    /// Diagnostics: write one line per frame to a new file, with the cursor, the ground under it,
    /// the camera and the tiles
    #[arg(long, value_name = "CSV")]
    pub trace: Option<PathBuf>,
}
