//! `corniche fly`: a flight over a package, frame by frame, with the cost of each frame as a
//! table, images and a chart.

mod chart;
mod list;
mod measured_run;
mod outputs;
mod pictures;
mod summary;

use std::{
    fs, panic,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc::{self, SyncSender},
    },
    thread,
};

use image::RgbaImage;

use self::{measured_run::MeasuredRun, outputs::Outputs};
use crate::{
    args::{FlyArgs, Roads},
    exit::ExitCode,
    failure::{CommandFailure, Result},
    interrupt, messages, overlays, packages, presets,
    progress::Progress,
    styles,
    table::Digits,
};
use corniche_styles::Style;
use corniche_viewer::{
    Detail, Lifted, PictureOptions, Replay, ReplayOptions, default_flight,
    flight::{Flight, WorkingCrs},
    gpu::Gpu,
    tiles::{BlockingPackage, MapPackage as _, Overlays, TileDecoder},
};
use corniche_window::{Watched, watch};
use corniche_work::{Observer as _, Stage};

/// Largest size of a keyframe file; a hundred thousand keyframes are smaller.
const MAX_PATH_BYTES: u64 = 32 << 20;

pub(crate) fn run(args: &FlyArgs) -> Result<()> {
    let outputs = Outputs::create(args)?;
    let style = args.look.styled(styles::style(&args.look.style)?);
    let methods = args.look.roads(&args.drawing.roads)?;
    let package = packages::source(&args.from.package)?;
    let flight = flight(args, &package)?;
    let overlays = overlays::load(&args.look, package.manifest())?;
    let (flown, methods) = (&flight, &methods);
    let plan = Plan { args, flight: flown, style: &style, methods, outputs: &outputs, overlays };
    let (runs, adapter) = if args.window { plan.fly_in_a_window()? } else { plan.fly(None)? };

    outputs.finish(&flight, WorkingCrs::from_manifest(package.manifest()), &runs, &adapter)?;
    let point_scale = package.manifest().point_scale;
    let digits = Digits::of_answers();
    Ok(messages::answer(&summary::to_text(&runs, point_scale, digits))?)
}

/// The requested flight, or else a pass along the data.
fn flight(args: &FlyArgs, package: &dyn BlockingPackage) -> Result<Flight> {
    let Some(path) = &args.flight.path else {
        return Ok(default_flight(package, &interrupt::is_noted)?);
    };
    let unusable =
        |error: &dyn std::error::Error| presets::refuse(&format!("flight {path:?}"), error);
    presets::refuse_stream(path).map_err(|error| unusable(&error))?;
    let size_bytes = fs::metadata(path).map_err(|error| unusable(&error))?.len();
    if size_bytes > MAX_PATH_BYTES {
        refuse!("flight {path:?}: the file is too large for a flight path");
    }
    let text = fs::read_to_string(path).map_err(|error| unusable(&error))?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let manifest = package.manifest();
    Flight::parse(text, WorkingCrs::from_manifest(manifest), &manifest.coordinates)
        .map_err(|error| unusable(&error))
}

/// All requested flights.
struct Plan<'a> {
    args: &'a FlyArgs,
    flight: &'a Flight,
    style: &'a Style,
    methods: &'a [Roads],
    outputs: &'a Outputs,
    overlays: Arc<Overlays>,
}

/// The results, and the name of the adapter that drew them.
type Drawn = (Vec<MeasuredRun>, String);

/// A window that shows frames while they are drawn.
struct Watcher<'a> {
    window: SyncSender<RgbaImage>,
    is_gone: &'a AtomicBool,
}

impl Plan<'_> {
    /// Flies in a separate thread, because on most systems a window must belong to the program's
    /// first thread, which is this one. Without a display the flight fails; if the window is lost
    /// during the flight, the flight continues without it.
    fn fly_in_a_window(&self) -> Result<Drawn> {
        // The channel holds one image, so the flight is at most one image ahead of the window.
        let (window, pictures) = mpsc::sync_channel(1);
        let is_gone = AtomicBool::new(false);
        let watcher = Watcher { window, is_gone: &is_gone };
        let name = self.args.from.package.file_name();
        thread::scope(|scope| {
            // When the thread ends, the watcher is dropped, so the channel and then the window
            // close.
            let worker = scope.spawn(move || self.fly(Some(&watcher)));
            let watched = watch(&name, self.args.drawing.size, pictures);
            let is_closed = match watched {
                Ok(Watched::Lost(error)) => {
                    let why = CommandFailure::from(error);
                    warning!("the window was lost; the flight continues without it: {why}");
                    Ok(false)
                }
                Ok(Watched::ToTheEnd) => Ok(false),
                Ok(Watched::InPart) => Ok(true),
                Err(error) => Err(error),
            };
            is_gone.store(!matches!(is_closed, Ok(false)), Ordering::SeqCst);
            let drawn = worker.join().unwrap_or_else(|panic| panic::resume_unwind(panic));
            let is_closed = is_closed?;
            match drawn {
                Err(failure)
                    if is_closed
                        && failure.code() == ExitCode::Interrupted
                        && !interrupt::is_noted() =>
                {
                    let closed = anyhow::anyhow!("the window was closed before the flight ended");
                    Err(CommandFailure::new(ExitCode::Interrupted, closed))
                }
                drawn => drawn,
            }
        })
    }

    fn fly(&self, watcher: Option<&Watcher<'_>>) -> Result<Drawn> {
        let gpu = Gpu::new()?;
        note!("drawn by {}", gpu.adapter_name);
        let mut runs = Vec::new();
        for lod in once_each(&self.args.drawing.lod) {
            for roads in once_each(self.methods) {
                runs.push(self.fly_once(&gpu, watcher, lod, roads)?);
            }
        }
        Ok((runs, gpu.adapter_name.clone()))
    }

    fn fly_once(
        &self,
        gpu: &Gpu,
        watcher: Option<&Watcher<'_>>,
        lod: Detail,
        roads: Roads,
    ) -> Result<MeasuredRun> {
        let drawing = &self.args.drawing;
        let options = ReplayOptions {
            picture: PictureOptions {
                size_px: drawing.size,
                roads: self.args.look.road_options(roads),
                screen_space_error_px: drawing.ground.screen_space_error,
                cell_px: drawing.ground.cell_px,
                exaggeration: drawing.ground.exaggeration,
                supersampling: drawing.supersampling,
                style: self.style.clone(),
                layers: self.args.look.shown_layers(),
            },
            detail: lod,
            budget: drawing.gpu.budget(),
            ahead_s: drawing.ahead,
            frames: frames(self.args, self.flight)?,
        };
        let picture = &options.picture;
        let package = packages::source(&self.args.from.package)?;
        let looks = picture.looks(package.manifest());
        let decoder = TileDecoder::default().for_look(
            picture.roads.method,
            &picture.style,
            looks.drawn_layers(),
        );
        let package = package.with_decoder(decoder.with_overlays(Arc::clone(&self.overlays)));
        let is_stopped = || {
            let is_gone = watcher.is_some_and(|watcher| watcher.is_gone.load(Ordering::SeqCst));
            is_gone || interrupt::is_noted()
        };
        let mut replay = Replay::new(gpu, &package, self.flight, &options, &is_stopped)?;
        let mut run = MeasuredRun { lod, roads, frames: Vec::new() };
        let Lifted { frames, most_m } = replay.lifted();
        if frames > 0 {
            note!(
                "note: {}: in {frames} frames the camera was raised to stay above the ground, by up to {most_m:.1} m",
                run.name()
            );
        }
        note!("flying {}", run.name());
        let progress = Progress::new();
        progress.begin(Stage::Fly, Some(options.frames.into()));
        while let Some(record) = replay.next_frame()? {
            let name = format!("{}-{:05}.png", run.words().join("-"), record.frame);
            self.outputs.add_picture(&name, &replay)?;
            if let Some(watcher) = watcher {
                // This fails only if the window is closed or lost; `is_gone` then ends the flight
                // or lets it continue.
                let _ = watcher.window.send(replay.picture()?);
            }
            run.frames.push(record);
            progress.advance(Stage::Fly, 1);
        }
        progress.finish();
        if let Some(doubt) = run.doubt() {
            warning!("{}: {doubt}", run.name());
        }
        Ok(run)
    }
}

/// The number of frames: `--frames`, or the number that spaces them about `--step` apart.
fn frames(args: &FlyArgs, flight: &Flight) -> Result<u32> {
    match args.flight.step {
        None => Ok(args.flight.frames),
        // A number too large for u32 becomes the largest u32, which the replay rejects.
        Some(step_s) if step_s > 0.0 => {
            Ok(((flight.duration_s() / step_s).round() as u32).saturating_add(1))
        }
        Some(step_s) => Err(unusable!("--step must be greater than 0 seconds, not {step_s}")),
    }
}

/// The given values in their order, without duplicates.
fn once_each<T: Copy + PartialEq>(given: &[T]) -> Vec<T> {
    given
        .iter()
        .enumerate()
        .filter(|(k, one)| !given[..*k].contains(one))
        .map(|(_, one)| *one)
        .collect()
}

#[cfg(test)]
#[path = "fly_tests.rs"]
mod tests;
