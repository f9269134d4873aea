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

/// How movements of the camera end.
const MOTIONS: Words<bool, 2> =
    [("soft", "They slow down smoothly", true), ("prompt", "They end at once", false)];

#[derive(Debug, Args)]
pub(crate) struct ViewArgs {
    #[command(flatten)]
    pub(crate) from: PackageArg,
    /// How roads are drawn at first [default: sv, and geo without a graphics card, where sv takes long]
    #[arg(long, value_parser = Roads::one_method())]
    pub(crate) roads: Option<Roads>,
    #[command(flatten)]
    pub(crate) look: LookArgs,
    /// Width and height of the window at first, in pixels. Less by default than for pictures, so that it fits on a screen
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1280x800", value_parser = parse_size)]
    pub(crate) size: [u32; 2],
    #[command(flatten)]
    pub(crate) camera: CameraArgs,
    #[command(flatten)]
    pub(crate) ground: GroundArgs,
    /// Samples per pixel along each side, averaged [default: 2, and 1 without a graphics card, where more is too slow to move about]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4))]
    pub(crate) supersampling: Option<u32>,
    #[command(flatten)]
    pub(crate) gpu: GpuArgs,
    /// How movements end
    #[arg(long, value_parser = one_of(MOTIONS), default_value = "soft", action = ArgAction::Set)]
    pub(crate) motion: bool,
    /// Lines to change with the mouse (key L): a GeoJSON file, made if it is not there. They are saved there with Ctrl S and at the end
    /// [default: a new file in --folder]
    #[arg(long, value_name = "GEOJSON")]
    pub(crate) draw: Option<PathBuf>,
    /// Where pictures (key P) and recorded flights (key C) are saved, numbered; no file is replaced
    #[arg(long, value_name = "FOLDER", default_value = ".")]
    pub(crate) folder: PathBuf,
    /// Diagnostic: write a line per frame to a new file, with the cursor, the ground under it, the camera and the tiles
    #[arg(long, value_name = "CSV")]
    pub(crate) trace: Option<PathBuf>,
}
