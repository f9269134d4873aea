//! `corniche view`: a window on a package.

use std::{
    fs, io,
    path::{Path, PathBuf},
    sync::Arc,
};

use clap::{Args, ValueEnum};
use corniche_styles::style_preset_names;
use corniche_viewer::{stream::StreamBudget, tiles::PackageSource};
use corniche_window::{
    BeginTrace, Closed, End, NamedStyle, Reload, WindowError, WindowRequest, controls::Inertia,
    run as open_window,
};

use crate::{
    args::{CameraArgs, LookArgs, Roads, parse_bytes, parse_size},
    exit::ExitCode,
    failure::Failure,
    interrupt,
    output::{Existing, Output},
    styles::{StyleFile, file_of, style},
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
    #[command(flatten)]
    pub(crate) camera: CameraArgs,
    /// Terrain error that may be seen, in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 2.0)]
    pub(crate) screen_space_error: f64,
    /// Vertical exaggeration
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    pub(crate) exaggeration: f64,
    /// Samples per pixel along each side, averaged [default: 2, and 1 without a graphics card]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4))]
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
    /// Where pictures (key P) and recorded flights (key C) are saved, numbered; no file is replaced
    #[arg(long, value_name = "FOLDER", default_value = ".")]
    pub(crate) folder: PathBuf,
    /// Diagnostic: write a line per frame to a new file, with the cursor, the ground under it, the camera and the tiles
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
    let used: Vec<&Path> =
        [Some(args.package.as_path()), file_of(chosen)].into_iter().flatten().collect();
    let trace = args.trace.as_deref().map(|path| begin_trace(path, &used)).transpose()?;
    if args.folder.exists() && !args.folder.is_dir() {
        return Err(Failure::unusable(format!(
            "--folder {} is a file; give a folder for pictures and flights",
            args.folder.display()
        )));
    }
    let source = PackageSource::open(&args.package)?;
    let request = WindowRequest {
        name: args.package.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        source: Arc::new(source),
        size_px: args.size,
        camera: args.camera.request(),
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
        trace,
        is_stopped: Box::new(interrupt::is_noted),
    };
    let Closed { end, last_files } = open_window(request);
    let mut code = ExitCode::Done;
    for saved in last_files {
        match saved {
            Ok(path) => eprintln!("saved {}", path.display()),
            Err(error) => {
                let lost = Failure::new(ExitCode::Failed, error);
                lost.tell();
                code = lost.code();
            }
        }
    }
    match end? {
        End::Closed => Ok(code),
        End::Stopped => Err(Failure::interrupted()),
    }
}

/// Checks where the trace is to be, as with any other file; it is begun when there is a window. Whoever reads along finds
/// it there from the first line on, so it does not wait beside its place until it is complete.
fn begin_trace(path: &Path, used: &[&Path]) -> Result<BeginTrace, Failure> {
    drop(Output::create(path, Existing::Replace, used)?);
    if path.symlink_metadata().is_ok() {
        return Err(Failure::new(
            ExitCode::Exists,
            anyhow::anyhow!("--trace {} exists already; choose another name", path.display()),
        ));
    }
    let path = path.to_owned();
    Ok(Box::new(move || {
        let begun = fs::OpenOptions::new().write(true).create_new(true).open(&path);
        let file = begun.map_err(|error| {
            io::Error::new(error.kind(), format!("{}: {error}", path.display()))
        })?;
        Ok(Box::new(file))
    }))
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
            WindowError::Load(_)
            | WindowError::NoGround { .. }
            | WindowError::OverBudget { .. }
            | WindowError::OffGround(_)
            | WindowError::Range(_)
            | WindowError::NoStyle
            | WindowError::Trace { .. } => ExitCode::Unusable,
            _ => ExitCode::Failed,
        };
        Self::new(code, error)
    }
}
