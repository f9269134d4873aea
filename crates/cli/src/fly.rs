//! `corniche fly`: a flight over a package, frame by frame: what each costs, as a list, pictures and a chart.

mod list;
mod summary;

use std::{
    fs,
    io::{self, Write as _},
    path::{Path, PathBuf},
};

use corniche_viewer::{
    Detail, FrameRecord, Replay, ReplayError, ReplayOptions, RoadMethod, RoadOptions,
    default_flight,
    flight::Flight,
    gpu::{Gpu, GpuError},
    stream::StreamBudget,
    style::Style,
    tiles::PackageSource,
};
use tempfile::TempDir;

use crate::{
    args::{FlyArgs, Lod, Roads},
    exit::ExitCode,
    failure::Failure,
    flight_chart, interrupt,
    output::{Existing, Output},
};

/// A text of keyframes is no longer than this: a hundred thousand of them take less.
const MAX_PATH_BYTES: u64 = 32 << 20;
/// Tiles being decoded at once.
const TILES_IN_FLIGHT: usize = 8;

/// One flight with one method and one choice of tiles.
pub(crate) struct Run {
    pub(crate) lod: Lod,
    pub(crate) roads: Roads,
    pub(crate) frames: Vec<FrameRecord>,
}

impl Run {
    pub(crate) fn name(&self) -> String {
        format!("{}, roads {}", self.lod.word(), self.roads.word())
    }
}

pub(crate) fn run(args: &FlyArgs) -> Result<ExitCode, Failure> {
    let existing = if args.overwrite { Existing::Replace } else { Existing::Keep };
    let mut used: Vec<&Path> = vec![&args.package];
    used.extend(args.flight.path.as_deref());
    let csv = Output::create(&args.output, existing, &used)?;
    used.push(&args.output);
    let svg = create(args.svg.as_deref(), existing, &mut used)?;
    let save_path = create(args.flight.save_path.as_deref(), existing, &mut used)?;
    let pictures = args.png.as_deref().map(|folder| Pictures::create(folder, &used)).transpose()?;

    let source = PackageSource::open(&args.package)?;
    let flight = flight(args, &source)?;
    interrupt::watch()?;
    let gpu = Gpu::new().map_err(|error| Failure::new(ExitCode::Failed, error))?;
    eprintln!("drawn by {}", gpu.adapter_name());
    let mut runs = Vec::new();
    for lod in once_each(&args.drawing.lod) {
        for roads in once_each(&args.drawing.roads) {
            runs.push(Run {
                lod,
                roads,
                frames: fly(args, &gpu, &flight, lod, roads, pictures.as_ref())?,
            });
        }
    }

    if let Some(pictures) = pictures {
        pictures.finish()?;
    }
    if let Some(svg) = svg {
        let drawing = flight_chart::frame_times(&runs, gpu.adapter_name())
            .map_err(|error| Failure::new(ExitCode::Failed, error))?;
        svg.write_whole(drawing.as_bytes())?;
    }
    if let Some(save_path) = save_path {
        let text = flight.to_text().map_err(|error| Failure::new(ExitCode::Failed, error))?;
        save_path.write_whole(text.as_bytes())?;
    }
    csv.write_whole(list::to_csv(&runs).as_bytes())?;
    io::stdout().lock().write_all(summary::to_text(&runs).as_bytes())?;
    Ok(ExitCode::Done)
}

/// Begins a file that is wanted, which is none of those `used`; then it is used too.
fn create<'a>(
    path: Option<&'a Path>,
    existing: Existing,
    used: &mut Vec<&'a Path>,
) -> Result<Option<Output>, Failure> {
    let Some(path) = path else { return Ok(None) };
    let output = Output::create(path, existing, used)?;
    used.push(path);
    Ok(Some(output))
}

/// The flight asked for, else a pass along the data.
fn flight(args: &FlyArgs, source: &PackageSource) -> Result<Flight, Failure> {
    let Some(path) = &args.flight.path else { return Ok(default_flight(source)?) };
    let unusable =
        |error: &dyn std::fmt::Display| Failure::unusable(format!("{}: {error}", path.display()));
    let size_bytes = fs::metadata(path).map_err(|error| unusable(&error))?.len();
    if size_bytes > MAX_PATH_BYTES {
        return Err(unusable(&"too large for a flight"));
    }
    let text = fs::read_to_string(path).map_err(|error| unusable(&error))?;
    Flight::parse(&text, &source.manifest().coordinates).map_err(|error| unusable(&error))
}

fn fly(
    args: &FlyArgs,
    gpu: &Gpu,
    flight: &Flight,
    lod: Lod,
    roads: Roads,
    pictures: Option<&Pictures>,
) -> Result<Vec<FrameRecord>, Failure> {
    let method = RoadMethod::from(roads);
    let source = PackageSource::open(&args.package)?.for_method(method);
    let options = ReplayOptions {
        size_px: args.drawing.size,
        roads: RoadOptions::of(method),
        detail: match lod {
            Lod::Full => Detail::Full,
            Lod::Culled => Detail::Culled,
            Lod::Adaptive => Detail::Adaptive,
        },
        screen_space_error_px: args.drawing.screen_space_error,
        exaggeration: args.drawing.exaggeration,
        style: Style::road_atlas(),
        budget: StreamBudget {
            tiles_in_flight: TILES_IN_FLIGHT,
            upload_bytes_per_frame: args.drawing.upload_per_frame,
            gpu_bytes: args.drawing.gpu_memory,
        },
        ahead_s: args.drawing.ahead,
        frames: frames(args, flight)?,
    };
    let mut replay = Replay::new(gpu, &source, flight, &options)?;
    let mut records = Vec::new();
    while let Some(record) = next_frame(&mut replay)? {
        if let Some(pictures) = pictures {
            let name = format!("{}-{}-{:05}.png", lod.word(), roads.word(), record.frame);
            pictures.add(&name, &replay)?;
        }
        records.push(record);
    }
    Ok(records)
}

fn next_frame(replay: &mut Replay<'_>) -> Result<Option<FrameRecord>, Failure> {
    if interrupt::is_noted() {
        return Err(Failure::new(ExitCode::Interrupted, anyhow::anyhow!("interrupted")));
    }
    Ok(replay.next_frame()?)
}

/// So many frames that they lie about `--step` apart, else `--frames`.
fn frames(args: &FlyArgs, flight: &Flight) -> Result<u32, Failure> {
    match args.flight.step {
        None => Ok(args.flight.frames),
        // A cast takes what is too many to the most, which the replay refuses.
        Some(step_s) if step_s > 0.0 => {
            Ok(((flight.duration_s() / step_s).round() as u32).saturating_add(1))
        }
        Some(step_s) => Err(Failure::unusable(format!(
            "--step of {step_s} is no time from one frame to the next; give seconds above 0"
        ))),
    }
}

/// In the order given, without what was given before.
fn once_each<T: Copy + PartialEq>(given: &[T]) -> Vec<T> {
    given
        .iter()
        .enumerate()
        .filter(|(k, one)| !given[..*k].contains(one))
        .map(|(_, one)| *one)
        .collect()
}

/// A folder of pictures that takes its place when it is complete.
struct Pictures {
    target: PathBuf,
    folder: TempDir,
}

impl Pictures {
    fn create(target: &Path, used: &[&Path]) -> Result<Self, Failure> {
        let unusable = |reason: &dyn std::fmt::Display| {
            Failure::unusable(format!("cannot write pictures to {}: {reason}", target.display()))
        };
        if used.contains(&target) {
            return Err(unusable(&"the command uses that file itself; choose another name"));
        }
        if target.symlink_metadata().is_ok() {
            return Err(Failure::new(
                ExitCode::Exists,
                anyhow::anyhow!(
                    "{} exists already; name a new folder for the pictures",
                    target.display()
                ),
            ));
        }
        let parent = match target.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        let mut builder = tempfile::Builder::new();
        // Temporary folders are their owner's alone; this one is to become an ordinary folder.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
        let folder = builder.tempdir_in(parent).map_err(|error| unusable(&error))?;
        Ok(Self { target: target.to_path_buf(), folder })
    }

    fn add(&self, name: &str, replay: &Replay<'_>) -> Result<(), Failure> {
        let picture = replay.picture()?;
        picture
            .save_with_format(self.folder.path().join(name), image::ImageFormat::Png)
            .map_err(|error| Failure::new(ExitCode::Failed, error))
    }

    fn finish(self) -> Result<(), Failure> {
        let Self { target, folder } = self;
        fs::rename(folder.path(), &target).map_err(|error| {
            Failure::new(
                ExitCode::Failed,
                anyhow::anyhow!("cannot move the pictures to {}: {error}", target.display()),
            )
        })?;
        // It is the user's folder now.
        let _ = folder.keep();
        Ok(())
    }
}

impl From<ReplayError> for Failure {
    fn from(error: ReplayError) -> Self {
        let code = match &error {
            ReplayError::ReadBack(_)
            | ReplayError::Gpu(GpuError::NoAdapter { .. } | GpuError::NoDevice { .. }) => {
                ExitCode::Failed
            }
            _ => ExitCode::Unusable,
        };
        Self::new(code, error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_given_twice_is_flown_once() {
        assert_eq!(once_each(&[Roads::Sv, Roads::Geo, Roads::Sv]), [Roads::Sv, Roads::Geo]);
        assert!(once_each::<Roads>(&[]).is_empty());
    }

    #[test]
    fn pictures_take_their_place_together_or_leave_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("frames");
        let pictures = Pictures::create(&target, &[]).unwrap();
        fs::write(pictures.folder.path().join("a.png"), b"a").unwrap();
        assert!(!target.exists());
        drop(pictures);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "litter");
        let pictures = Pictures::create(&target, &[]).unwrap();
        fs::write(pictures.folder.path().join("a.png"), b"a").unwrap();
        pictures.finish().unwrap();
        assert_eq!(fs::read(target.join("a.png")).unwrap(), b"a");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "litter");
        let refused = Pictures::create(&target, &[]).err().unwrap();
        assert_eq!(refused.code(), ExitCode::Exists);
        let list = folder.path().join("list.csv");
        assert_eq!(Pictures::create(&list, &[&list]).err().unwrap().code(), ExitCode::Unusable);
    }
}
