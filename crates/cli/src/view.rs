//! `corniche view`: a window on a package.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use corniche_presets::style_preset_names;
use corniche_viewer::{CameraRequest, camera::Orientation, stream::StreamBudget};
use corniche_window::{
    NamedStyle, Reload, WindowError, WindowRequest, controls::Inertia, run as open_window,
};

use crate::{
    args::{LookArgs, Roads, parse_bytes, parse_position, parse_size},
    exit::ExitCode,
    failure::Failure,
    styles::{StyleFile, style},
};

/// Tiles being decoded at once.
const TILES_IN_FLIGHT: usize = 8;

/// Whether movements run out softly.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Motion {
    /// They run out softly
    Soft,
    /// They happen at once
    Prompt,
}

#[derive(Debug, Args)]
pub(crate) struct ViewArgs {
    /// The package
    pub(crate) package: PathBuf,
    /// How roads are drawn at first
    #[arg(long, value_enum, default_value_t = Roads::Sv)]
    pub(crate) roads: Roads,
    #[command(flatten)]
    pub(crate) look: LookArgs,
    /// Width and height of the window at first, in pixels
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1280x800", value_parser = parse_size)]
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
    /// Tilt of the view, in degrees: 0 looks straight down, 85 almost at the horizon
    #[arg(long, value_name = "DEGREES", default_value_t = 60.0, requires = "look_at")]
    pub(crate) pitch: f64,
    /// Terrain error that may be seen, in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 2.0)]
    pub(crate) screen_space_error: f64,
    /// Vertical exaggeration
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    pub(crate) exaggeration: f64,
    /// Samples per pixel along each side, averaged [default: 2, and 1 without a graphics card]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=3))]
    pub(crate) supersampling: Option<u32>,
    /// Memory for tiles on the graphics card, such as 512M or 4G
    #[arg(long, value_name = "BYTES", default_value = "512M", value_parser = parse_bytes)]
    pub(crate) gpu_memory: u64,
    /// Handed to the graphics card in a frame at most, though always a whole tile
    #[arg(long, value_name = "BYTES", default_value = "4M", value_parser = parse_bytes)]
    pub(crate) upload_per_frame: u64,
    /// How movements end
    #[arg(long, value_enum, default_value_t = Motion::Soft)]
    pub(crate) motion: Motion,
    /// Where pictures (key P) and recorded flights are saved, numbered
    #[arg(long, value_name = "FOLDER", default_value = ".")]
    pub(crate) folder: PathBuf,
    /// Diagnostic: write a line per frame, with the cursor, the ground under it, the camera and the tiles
    #[arg(long, value_name = "CSV")]
    pub(crate) trace: Option<PathBuf>,
}

pub(crate) fn run(args: &ViewArgs) -> Result<ExitCode, Failure> {
    let chosen = &args.look.style;
    let mut styles = vec![NamedStyle { name: chosen.clone(), style: style(chosen)? }];
    for name in style_preset_names().filter(|name| name != chosen) {
        styles.push(NamedStyle { name: name.to_owned(), style: style(name)? });
    }
    let roads = args.look.roads(&[args.roads])?[0];
    let request = WindowRequest {
        package: args.package.clone(),
        size_px: args.size,
        camera: match args.look_at {
            Some([lon_deg, lat_deg]) => CameraRequest::LookAt {
                lon_deg,
                lat_deg,
                distance_m: args.distance,
                orientation: Orientation { heading_deg: args.heading, pitch_deg: args.pitch },
            },
            None => CameraRequest::FrameAll,
        },
        roads: args.look.road_options(roads),
        styles,
        reload: reload(chosen),
        screen_space_error_px: args.screen_space_error,
        exaggeration: args.exaggeration,
        samples_per_side: args.supersampling,
        budget: StreamBudget {
            tiles_in_flight: TILES_IN_FLIGHT,
            upload_bytes_per_frame: args.upload_per_frame,
            gpu_bytes: args.gpu_memory,
        },
        inertia: match args.motion {
            Motion::Soft => Inertia::On,
            Motion::Prompt => Inertia::Off,
        },
        folder: args.folder.clone(),
        trace: args.trace.clone(),
    };
    open_window(request)?;
    Ok(ExitCode::Done)
}

/// Reads the file of a style again whenever it changes.
fn reload(name_or_path: &str) -> Option<Reload> {
    let mut file = StyleFile::of(name_or_path)?;
    Some(Box::new(move || {
        let style = file.reload_if_changed()?;
        Some(style.map_err(|failure| failure.to_string()))
    }))
}

impl From<WindowError> for Failure {
    fn from(error: WindowError) -> Self {
        let code = match &error {
            WindowError::Open(_)
            | WindowError::Load(_)
            | WindowError::NoGround { .. }
            | WindowError::OffGround { .. }
            | WindowError::Range { .. }
            | WindowError::NoStyle
            | WindowError::Trace { .. } => ExitCode::Unusable,
            _ => ExitCode::Failed,
        };
        Self::new(code, error)
    }
}
