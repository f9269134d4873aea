//! Turns arguments and settings files into checked settings.

use std::{
    mem,
    num::NonZeroUsize,
    path::{Path, PathBuf},
    thread,
};

use corniche_areas::{AreaTable, ClassedLayer};
use corniche_gis::Polygon;
use corniche_ground::terrain::recorded::TerrainRecord;
use corniche_presets::{
    AreaOptions, BoundsChoice, InputFiles, OutputFiles, PhotoOptions, RoadOptions, TerrainOptions,
    class_filter, is_photo_off, parse_bytes,
};
use corniche_roads::ClassFilter;
use corniche_spec::{
    PhotoChoice, PhotoSettings, PlanSettings, Resources, RoadSettings, TerrainSettings,
    inputs::{elevation_names, extract_names, input_name},
    machine::{MIN_MEMORY_BYTES, default_memory_bytes},
};

use crate::{args::WorkArgs, credits, exit::ExitCode, failure::Failure, presets};

/// Default quality of photos: at 85 they take a fifth more bytes for half a decibel (docs/lab/measured.md).
const PHOTO_QUALITY: u8 = 80;
/// What to make, and with what.
pub(crate) struct Work {
    pub(crate) plan: PlanSettings,
    pub(crate) resources: Resources,
    /// Where intermediate results go.
    pub(crate) tmp: Option<PathBuf>,
    pub(crate) force: bool,
}

/// Puts what the settings file says where the command line says nothing, and gives what it says of outputs.
pub(crate) fn complete(args: &mut WorkArgs) -> Result<OutputFiles, Failure> {
    let Some(path) = &args.config else { return Ok(OutputFiles::default()) };
    let folder = path.parent().unwrap_or(Path::new(""));
    let config = presets::read_config(path)?.in_folder(folder);
    args.inputs = mem::take(&mut args.inputs).or(config.inputs);
    let InputFiles { dem, terrain, .. } = &args.inputs;
    let place = path.display();
    if dem.is_empty() && terrain.is_none() {
        return Err(Failure::unusable(format!(
            "no elevation is named; give --dem FILE, or dem under [inputs] in {place}"
        )));
    }
    if !dem.is_empty() && terrain.is_some() {
        return Err(Failure::unusable(format!(
            "{place} has dem and terrain under [inputs]; terrain comes from one of them, so leave the other out"
        )));
    }
    args.photos = mem::take(&mut args.photos).or(config.photo);
    args.terrain = mem::take(&mut args.terrain).or(config.terrain);
    args.roads = mem::take(&mut args.roads).or(config.roads);
    args.areas = mem::take(&mut args.areas).or(config.areas);
    args.resources = mem::take(&mut args.resources).or(config.resources);
    Ok(config.output)
}

/// The only place where text becomes settings. The command line has precedence over the settings file, which has precedence
/// over the defaults; [`complete`] has put both together.
pub(crate) fn of(args: WorkArgs) -> Result<Work, Failure> {
    let WorkArgs { inputs, terrain, roads, resources, .. } = args;
    // What is not given is as it was when the package was made whose terrain is taken, else the usual.
    let base = match &inputs.terrain {
        Some(package) => TerrainRecord::of_package(package)?,
        None => TerrainRecord { terrain: TerrainSettings::usual(), attribution: Vec::new() },
    };
    let given = [args.attribution, terrain.attribution.clone()];
    let attribution = given.into_iter().find(|credits| !credits.is_empty());
    let mut attribution = attribution.unwrap_or(base.attribution);
    let photo = photo_choice(&inputs.photo, &args.photos)?;
    if let PhotoChoice::Files(_) = photo {
        // The package whose terrain is taken may have the same photos.
        let credit = args.photos.attribution.filter(|credit| !attribution.contains(credit));
        attribution.extend(credit);
    }
    credits::check(&attribution)?;
    let osm = extract_names(&inputs.osm)?;
    let areas = area_table(&args.areas, &osm)?;
    let lines = lines(&args.areas, &osm)?;
    let bounds = terrain.bounds.map(|bounds| in_degrees(bounds, &osm)).transpose()?;
    let polygon = inputs.polygon.map(polygon).transpose()?;
    let dem = elevation_names(&inputs.dem)?;
    let mut terrain = terrain_settings(TerrainOptions { bounds, ..terrain }, base.terrain)?;
    terrain.plan.polygon = polygon;
    terrain.allow_fine_cell = args.force;
    let plan = PlanSettings {
        dem,
        terrain_of: inputs.terrain,
        osm,
        areas,
        lines,
        photo,
        attribution,
        terrain,
        roads: road_settings(roads)?,
        generator: generator(),
    };
    let (tmp, force) = (resources.tmp, args.force);
    let resources = self::resources(resources.threads, resources.memory.as_deref())?;
    tracing::debug!(
        dem = ?plan.dem,
        terrain_of = ?plan.terrain_of,
        osm = ?plan.osm,
        photo = ?plan.photo,
        terrain = ?plan.terrain,
        simplify_cells = plan.roads.simplify_cells,
        threads = resources.threads,
        memory_bytes = resources.memory_bytes,
        "settings"
    );
    Ok(Work { plan, resources, tmp, force })
}

/// Reads a polygon.
pub(crate) fn polygon(path: PathBuf) -> Result<Polygon, Failure> {
    let read = Polygon::read(&input_name(path).map_err(Failure::unusable)?);
    read.map_err(|error| Failure::new(ExitCode::Unusable, error))
}

/// The bounds in degrees, which an extract may have to tell.
fn in_degrees(bounds: BoundsChoice, osm: &[PathBuf]) -> Result<BoundsChoice, Failure> {
    match bounds {
        BoundsChoice::Degrees(_) => Ok(bounds),
        BoundsChoice::Osm if !osm.is_empty() => {
            Ok(BoundsChoice::Degrees(corniche_spec::extract_bounds(osm)?))
        }
        BoundsChoice::Osm => Err(Failure::unusable(
            "--bounds osm takes the bounds of the extract; give one with --osm",
        )),
    }
}

/// Puts an option, if it is given, in its place in the checked settings.
macro_rules! give {
    (($options:ident to $settings:ident) $name:ident $key:ident [$($path:tt)+] $usual:tt) => {
        if let Some(value) = $options.$name {
            $settings.$($path)+ = value.into();
        }
    };
}

/// The settings that are given; others are those of `base`.
fn terrain_settings(
    options: TerrainOptions,
    base: TerrainSettings,
) -> Result<TerrainSettings, Failure> {
    options.check().map_err(Failure::unusable)?;
    let mut settings = TerrainSettings {
        allow_ballpark: options.allow_ballpark,
        max_error_m: options.max_error.or(base.max_error_m),
        ..base
    };
    corniche_settings::placed! { Terrain [give] (options to settings) }
    Ok(settings)
}

/// Which photos the package gets, and how they are made.
fn photo_choice(names: &[PathBuf], options: &PhotoOptions) -> Result<PhotoChoice, Failure> {
    // A settings file may say how photos are made that the command line does not want.
    if is_photo_off(names) {
        return Ok(PhotoChoice::Off);
    }
    if names.is_empty() {
        return if *options == PhotoOptions::default() {
            Ok(PhotoChoice::OfTerrain)
        } else {
            Err(Failure::unusable(
                "--photo-levels, --photo-quality and --photo-attribution have an effect only with photos that are read; give them together with --photo FILE",
            ))
        };
    }
    let quality = options.quality.unwrap_or(PHOTO_QUALITY);
    if !(1..=100).contains(&quality) {
        return Err(Failure::unusable(format!(
            "--photo-quality must be from 1 to 100, not {quality}"
        )));
    }
    let files = corniche_spec::inputs::photo_names(names)?;
    Ok(PhotoChoice::Files(PhotoSettings { files, levels: options.levels, quality }))
}

/// The table of areas; `None` without.
fn area_table(options: &AreaOptions, osm: &[PathBuf]) -> Result<Option<AreaTable>, Failure> {
    match options.table.as_deref() {
        None | Some("off") => Ok(None),
        Some(_) if osm.is_empty() => {
            Err(Failure::unusable("--areas takes areas from an extract; give one with --osm"))
        }
        Some(table) => presets::area_table(table).map(Some),
    }
}

/// The layers of lines that are wanted.
fn lines(options: &AreaOptions, osm: &[PathBuf]) -> Result<Vec<ClassedLayer>, Failure> {
    let is_wanted = |layer: &ClassedLayer| match layer {
        ClassedLayer::Boundaries => options.boundaries == Some(true),
    };
    let wanted: Vec<_> = ClassedLayer::ALL.into_iter().filter(is_wanted).collect();
    match wanted.first() {
        Some(layer) if osm.is_empty() => {
            let name = layer.name();
            Err(Failure::unusable(format!(
                "--{name} takes {name} from an extract; give one with --osm"
            )))
        }
        _ => Ok(wanted),
    }
}

fn road_settings(options: RoadOptions) -> Result<RoadSettings, Failure> {
    options.check().map_err(Failure::unusable)?;
    let filter = match options.class_max_cell {
        _ if options.all_classes => ClassFilter::all(),
        Some(cells) => class_filter(&cells).map_err(|error| presets::refuse("settings", &error))?,
        None => ClassFilter::usual(),
    };
    let table = presets::frc_table(options.frc_table.as_deref().unwrap_or("default"))?;
    let table = match &options.classes {
        Some(classes) => table
            .with_classes(classes.numbers())
            .map_err(|error| presets::refuse("--classes", &error))?,
        None => table,
    };
    let mut settings = RoadSettings { filter, ..RoadSettings::of(table) };
    corniche_settings::placed! { Roads [give] (options to settings) }
    Ok(settings)
}

/// Program and version.
pub(crate) fn generator() -> String {
    format!("corniche {}", env!("CARGO_PKG_VERSION"))
}

/// What a run may use.
pub(crate) fn resources(
    threads_asked: Option<NonZeroUsize>,
    memory: Option<&str>,
) -> Result<Resources, Failure> {
    let memory_bytes = match memory {
        Some(text) => match parse_bytes(text) {
            Ok(size_bytes) if size_bytes >= MIN_MEMORY_BYTES => size_bytes,
            _ => {
                return Err(Failure::unusable(format!(
                    "--memory {text:?} is not a size of at least 256M; write it like 512M, 800MB, 0.5G or 1T"
                )));
            }
        },
        None => default_memory_bytes(),
    };
    Ok(Resources { threads: threads(threads_asked), memory_bytes })
}

/// The number of threads that is asked for, else one per processor.
pub(crate) fn threads(asked: Option<NonZeroUsize>) -> usize {
    asked.or_else(|| thread::available_parallelism().ok()).map_or(1, NonZeroUsize::get)
}

#[cfg(test)]
#[path = "settings_tests.rs"]
mod tests;
