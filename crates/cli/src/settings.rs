//! Converts arguments and settings files to checked settings.

use std::{
    mem,
    num::NonZeroUsize,
    path::{Path, PathBuf},
    thread,
};

use corniche_gis::RegionPolygons;
use corniche_ground::terrain::recorded::TerrainRecord;
use corniche_layers::{LayerTable, stacked_layers};
use corniche_presets::{
    BoundsChoice, InputFiles, LayerOptions, OutputFiles, PhotoOptions, RoadOptions, TerrainOptions,
    class_filter, is_no_layers, is_photo_off, parse_bytes,
};
use corniche_roads::{ClassFilter, FunctionalRoadClass};
use corniche_spec::{
    PhotoChoice, PhotoSettings, PlanSettings, Resources, RoadSettings, TerrainSettings,
    inputs::{elevation_names, extract_names, input_name},
    machine::{MIN_MEMORY_BYTES, default_memory_bytes},
};

use crate::{
    args::WorkArgs,
    credits,
    failure::{CommandFailure, Result},
    layers, presets,
};

/// Default JPEG quality of photos: quality 85 needs a fifth more bytes for half a decibel
/// (docs/lab/measured.md).
const PHOTO_QUALITY: u8 = 80;
/// The work of a build: what to build, and from which inputs.
pub(crate) struct BuildWork {
    pub plan: PlanSettings,
    pub resources: Resources,
    /// The folder of intermediate results.
    pub tmp: Option<PathBuf>,
    pub force: bool,
}

/// Fills in missing arguments from the settings file, and returns its settings of outputs.
pub(crate) fn complete(args: &mut WorkArgs) -> Result<OutputFiles> {
    let Some(path) = &args.config else { return Ok(OutputFiles::default()) };
    let folder = path.parent().unwrap_or(Path::new(""));
    let config = presets::read_config(path)?.in_folder(folder);
    args.inputs = mem::take(&mut args.inputs).or(config.inputs);
    let InputFiles { dem, terrain, .. } = &args.inputs;
    let place = format!("{path:?}");
    if dem.is_empty() && terrain.is_none() {
        refuse!(
            "no elevation data is named; pass --dem FILE, or write dem under [inputs] in {place}"
        );
    }
    if !dem.is_empty() && terrain.is_some() {
        refuse!(
            "{place} has both dem and terrain under [inputs]; only one of them can be the source of the terrain, so remove the other one"
        );
    }
    args.photos = mem::take(&mut args.photos).or(config.photo);
    args.terrain = mem::take(&mut args.terrain).or(config.terrain);
    args.roads = mem::take(&mut args.roads).or(config.roads);
    args.layers = mem::take(&mut args.layers).or(config.layers);
    args.resources = mem::take(&mut args.resources).or(config.resources);
    Ok(config.output)
}

/// The only place where text is converted to settings. The command line has precedence over the
/// settings file, which has precedence over the defaults; [`complete`] has merged the first two.
pub(crate) fn build_work(args: WorkArgs) -> Result<BuildWork> {
    let WorkArgs { inputs, terrain, roads, resources, .. } = args;
    // Missing settings are those of the package whose terrain is reused, if any, and otherwise the
    // defaults.
    let base = match &inputs.terrain {
        Some(package) => TerrainRecord::of_package(package)?,
        None => TerrainRecord { terrain: TerrainSettings::usual(), attribution: Vec::new() },
    };
    let given = [args.attribution, terrain.attribution.clone()];
    let attribution = given.into_iter().find(|credits| !credits.is_empty());
    let mut attribution = attribution.unwrap_or(base.attribution);
    let photo = photo_choice(&inputs.photo, &args.photos)?;
    if let PhotoChoice::Files(_) = photo {
        // The package whose terrain is reused may have the same photos.
        let credit = args.photos.attribution.filter(|credit| !attribution.contains(credit));
        attribution.extend(credit);
    }
    credits::check(&attribution)?;
    let osm = extract_names(&inputs.osm)?;
    let layers = layer_tables(&args.layers, &osm)?;
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
        layers,
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
    Ok(BuildWork { plan, resources, tmp, force })
}

/// Reads a polygon.
pub(crate) fn polygon(path: PathBuf) -> Result<RegionPolygons> {
    Ok(RegionPolygons::read(&input_name(path).map_err(CommandFailure::unusable)?)?)
}

/// The bounds in degrees; with `osm` they are read from the extract.
fn in_degrees(bounds: BoundsChoice, osm: &[PathBuf]) -> Result<BoundsChoice> {
    match bounds {
        BoundsChoice::Degrees(_) => Ok(bounds),
        BoundsChoice::Osm if !osm.is_empty() => {
            Ok(BoundsChoice::Degrees(corniche_spec::extract_bounds(osm)?))
        }
        BoundsChoice::Osm => Err(unusable!("--bounds osm needs an extract; pass one with --osm")),
    }
}

/// Assigns an option, if it is given, to its place in the checked settings.
macro_rules! give {
    (($options:ident to $settings:ident) $name:ident $key:ident [$($path:tt)+] $usual:tt) => {
        if let Some(value) = $options.$name {
            $settings.$($path)+ = value.into();
        }
    };
}

/// The given settings; missing ones are those of `base`.
fn terrain_settings(options: TerrainOptions, base: TerrainSettings) -> Result<TerrainSettings> {
    options.check().map_err(CommandFailure::unusable)?;
    let mut settings = TerrainSettings {
        allow_ballpark: options.allow_ballpark,
        max_error_m: options.max_error.or(base.max_error_m),
        ..base
    };
    corniche_settings::placed! { Terrain [give] (options to settings) }
    Ok(settings)
}

/// The photos of the package, and how they are stored.
fn photo_choice(names: &[PathBuf], options: &PhotoOptions) -> Result<PhotoChoice> {
    // A settings file may have options for photos although the command line turns photos off.
    if is_photo_off(names) {
        return Ok(PhotoChoice::Off);
    }
    if names.is_empty() {
        return if *options == PhotoOptions::default() {
            Ok(PhotoChoice::OfTerrain)
        } else {
            Err(unusable!(
                "--photo-levels, --photo-quality and --photo-attribution apply only to photos that are read; pass photos with --photo FILE"
            ))
        };
    }
    let quality = options.quality.unwrap_or(PHOTO_QUALITY);
    if !(1..=100).contains(&quality) {
        refuse!("--photo-quality must be between 1 and 100, not {quality}");
    }
    let files = corniche_spec::inputs::photo_names(names)?;
    Ok(PhotoChoice::Files(PhotoSettings { files, levels: options.levels, quality }))
}

/// The tables of the layers, the lowest layer first.
fn layer_tables(
    LayerOptions { tables }: &LayerOptions,
    osm: &[PathBuf],
) -> Result<Vec<LayerTable>> {
    if tables.is_empty() || is_no_layers(tables) {
        return Ok(Vec::new());
    }
    if osm.is_empty() {
        refuse!("--layers needs an extract; pass one with --osm");
    }
    let tables: Vec<LayerTable> =
        tables.iter().map(|table| layers::table(table)).collect::<Result<_, _>>()?;
    let order = stacked_layers(&tables).map_err(|error| presets::refuse("--layers", &error))?;
    Ok(order.into_iter().map(|index| tables[index].clone()).collect())
}

fn road_settings(options: RoadOptions) -> Result<RoadSettings> {
    options.check().map_err(CommandFailure::unusable)?;
    let filter = match options.class_max_cell {
        _ if options.all_classes => ClassFilter::all(),
        Some(cells) => class_filter(&cells).map_err(|error| presets::refuse("settings", &error))?,
        None => ClassFilter::usual(),
    };
    let table = presets::frc_table(options.frc_table.as_deref().unwrap_or("default"))?;
    let table = match &options.classes {
        Some(classes) => {
            let classes = classes.classes(Some(&table), &table.class_labels());
            let classes = classes.map_err(|error| presets::refuse("--classes", &error))?;
            let numbers: Vec<u8> = classes.into_iter().map(FunctionalRoadClass::number).collect();
            table.with_classes(&numbers).map_err(|error| presets::refuse("--classes", &error))?
        }
        None => table,
    };
    let mut settings = RoadSettings { filter, ..RoadSettings::from_table(table) };
    corniche_settings::placed! { Roads [give] (options to settings) }
    Ok(settings)
}

/// The name and version of the program.
pub(crate) fn generator() -> String {
    format!("corniche {}", env!("CARGO_PKG_VERSION"))
}

/// The memory, threads and folders that a run may use.
pub(crate) fn resources(
    threads_asked: Option<NonZeroUsize>,
    memory: Option<&str>,
) -> Result<Resources> {
    let memory_bytes = match memory {
        Some(text) => match parse_bytes(text) {
            Ok(size_bytes) if size_bytes >= MIN_MEMORY_BYTES => size_bytes,
            _ => {
                refuse!(
                    "--memory {text:?} is not a size of at least 256M; write a size such as 512M, 800MB, 0.5G or 1T"
                );
            }
        },
        None => default_memory_bytes(),
    };
    Ok(Resources { threads: threads(threads_asked), memory_bytes })
}

/// The requested number of threads, or one per processor.
pub(crate) fn threads(asked: Option<NonZeroUsize>) -> usize {
    asked.or_else(|| thread::available_parallelism().ok()).map_or(1, NonZeroUsize::get)
}

#[cfg(test)]
#[path = "settings_tests.rs"]
mod tests;
