//! `corniche view`: opens a window on a package.

use std::{fs, io, path::Path, sync::Arc};

use corniche_styles::style_preset_names;
use corniche_viewer::{
    RoadMethod,
    gpu::GpuError,
    tiles::{MapPackage as _, TileDecoder},
};
use corniche_window::{
    BeginTrace, Closed, MapSettings, NamedStyle, Reload, WindowEnd, WindowError, WindowRequest,
    run as open_window,
};

use crate::{
    args::{OverlayArg, Roads, ViewArgs, with_overlays},
    drawing::DrawingFile,
    exit::ExitCode,
    failure::{CommandFailure, Result},
    interrupt, messages,
    output::{Existing, Output},
    overlays, packages, presets,
    styles::{StyleFile, files_of_look, style},
    view_command::command_of,
};

pub(crate) fn run(args: &ViewArgs) -> Result<ExitCode> {
    let chosen = &args.look.style;
    let mut styles = vec![NamedStyle { name: chosen.clone(), style: style(chosen)? }];
    for name in style_preset_names().filter(|name| name != chosen) {
        styles.push(NamedStyle { name: name.to_owned(), style: style(name)? });
    }
    let roads = args.look.roads(&[args.roads.unwrap_or(Roads::DEFAULT)])?[0];
    let used = files_of_look(&args.look, &args.from);
    let trace = args.trace.as_deref().map(|path| begin_trace(path, &used)).transpose()?;
    if args.folder.exists() && !args.folder.is_dir() {
        refuse!("--folder {:?} is a file; pass a folder for images and flights", args.folder);
    }
    let package = packages::source(&args.from.package)?;
    let overlays = overlays::load(&args.look, package.manifest())?;
    let package = Arc::new(package.with_decoder(TileDecoder::default().with_overlays(overlays)));
    let draw = args.draw.as_deref();
    let drawing = DrawingFile::begin(draw, &args.folder, &used, Arc::clone(&package))?;
    for named in &mut styles {
        named.style = with_overlays(&args.look.overlay, named.style.clone());
    }
    let request = WindowRequest {
        name: args.from.package.file_name(),
        size_px: args.size,
        camera: args.camera.request(),
        settings: MapSettings {
            photo: args.look.photo,
            layers: args.look.shown_layers(),
            screen_space_error_px: args.ground.screen_space_error,
            cell_px: args.ground.cell_px,
            exaggeration: args.ground.exaggeration,
            ..MapSettings::usual(args.look.road_options(roads))
        },
        software_method: software_method(args),
        class_labels: presets::class_labels(package.manifest()),
        command_of: command_of(
            args.from.package.name(),
            &args.look.overlay,
            args.look.allow_ballpark,
        ),
        styles,
        reload: reload(chosen, &args.look.overlay),
        overlays: overlays::names(&args.look.overlay),
        drawn_lines: drawing.lines,
        save_drawing: drawing.save,
        samples_per_side: args.supersampling,
        budget: args.gpu.budget(),
        has_inertia: args.motion,
        folder: args.folder.clone(),
        trace,
        is_stopped: Box::new(interrupt::is_noted),
    };
    let Closed { end, last_files } = open_window(request, package);
    let mut code = ExitCode::Done;
    for saved in last_files {
        match saved {
            Ok(path) => note!("saved {}", path.display()),
            Err(error) => {
                let lost = CommandFailure::new(ExitCode::Failed, error);
                messages::error(&lost);
                code = lost.code();
            }
        }
    }
    match end.map_err(with_way_out)? {
        WindowEnd::Closed => Ok(code),
        WindowEnd::Stopped => Err(CommandFailure::interrupted()),
    }
}

/// Adds a hint to errors of this computer's window system or GPU: a browser may still show the
/// package, also on another computer.
fn with_way_out(error: WindowError) -> CommandFailure {
    let gives_none = matches!(
        error,
        WindowError::NoDisplay { .. }
            | WindowError::System { .. }
            | WindowError::Surface { .. }
            | WindowError::NoFormat { .. }
            | WindowError::Gpu(GpuError::NoAdapter { .. } | GpuError::NoDevice { .. })
    );
    let failure = CommandFailure::from(error);
    if !gives_none {
        return failure;
    }
    let said = format!("{failure}; use `corniche serve` to show the package in a browser");
    CommandFailure::new(failure.code(), anyhow::anyhow!(said))
}

/// The default method for roads when the CPU renders: shadow volumes take several times as long as
/// geometry. `--cap-test` implies shadow volumes.
fn software_method(args: &ViewArgs) -> Option<RoadMethod> {
    let is_free = args.roads.is_none() && !args.look.needs_method();
    is_free.then_some(RoadMethod::Geometry)
}

/// Checks the path of the trace as for any other file. The file is created when the window exists,
/// and directly at its path, so that another program can read the trace while it is written.
fn begin_trace(path: &Path, used: &[&Path]) -> Result<BeginTrace> {
    drop(Output::create(path, Existing::Replace, used)?);
    if path.symlink_metadata().is_ok() {
        return Err(CommandFailure::exists(format!(
            "--trace {path:?} already exists; choose another name"
        )));
    }
    let path = path.to_owned();
    Ok(Box::new(move || {
        let begun = fs::OpenOptions::new().write(true).create_new(true).open(&path);
        let file =
            begun.map_err(|error| io::Error::new(error.kind(), format!("{path:?}: {error}")))?;
        Ok(Box::new(file))
    }))
}

/// Reads a style file again whenever it changes.
fn reload(name_or_path: &str, overlays: &[OverlayArg]) -> Option<Reload> {
    let mut file = StyleFile::find(name_or_path)?;
    let overlays = overlays.to_vec();
    Some(Box::new(move || {
        let style = file.reload_if_changed()?;
        let style = style.map(|style| with_overlays(&overlays, style));
        Some(style.map_err(|failure| failure.to_string()))
    }))
}
