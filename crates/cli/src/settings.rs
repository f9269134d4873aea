//! Turns arguments and settings files into checked settings.

use std::{
    mem,
    num::NonZeroUsize,
    path::{Path, PathBuf},
    thread,
};

use corniche_areas::{AreaTable, ClassedLayer};
use corniche_dem::{OpenOptions, PlanOptions};
use corniche_geom::Cell;
use corniche_gis::Polygon;
use corniche_ground::terrain::recorded::TerrainRecord;
use corniche_presets::{
    AreaOptions, BoundsChoice, InputFiles, OutputFiles, PhotoOptions, ReliefChoice, RoadOptions,
    TerrainOptions, check_cell, class_filter, is_photo_off, is_range, parse_memory,
};
use corniche_roads::ClassFilter;
use corniche_spec::{
    PhotoChoice, PhotoSettings, PlanSettings, Resources, RoadSettings, TerrainSettings,
};
use corniche_tileset::ReliefLevels;

use crate::{args::WorkArgs, credits, exit::ExitCode, failure::Failure, presets};

/// Default tolerance of the simplification of roads, in cells of the level: where a level is drawn its cells have a pixel or two, and a quarter
/// of one is not seen.
const SIMPLIFY_CELLS: f64 = 0.25;
/// Default quality of photos: at 85 they take a fifth more bytes for half a decibel (docs/lab/measured.md).
const PHOTO_QUALITY: u8 = 80;
/// Default distance over which voids are filled, in cells.
const FILL_VOIDS: u32 = 32;
/// The most values for "no data" that a package's manifest may list.
const MAX_NODATA: usize = 64;

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
    let given = InputFiles {
        dem: mem::take(&mut args.dem),
        terrain: args.terrain_of.take(),
        osm: mem::take(&mut args.osm),
        polygon: args.polygon.take(),
        photo: mem::take(&mut args.photo),
    };
    let InputFiles { dem, terrain, osm, polygon, photo } = given.or(config.inputs);
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
    (args.dem, args.terrain_of, args.osm, args.polygon) = (dem, terrain, osm, polygon);
    args.photo = photo;
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
    let WorkArgs { terrain, roads, resources, .. } = args;
    // What is not given is as it was when the package was made whose terrain is taken, else the usual.
    let base = match &args.terrain_of {
        Some(package) => TerrainRecord::of_package(package)?,
        None => usual_terrain(),
    };
    let given = [args.attribution, terrain.attribution.clone()];
    let attribution = given.into_iter().find(|credits| !credits.is_empty());
    let mut attribution = attribution.unwrap_or(base.attribution);
    let photo = photo_choice(&args.photo, &args.photos)?;
    if let PhotoChoice::Files(_) = photo {
        // The package whose terrain is taken may have the same photos.
        let credit = args.photos.attribution.filter(|credit| !attribution.contains(credit));
        attribution.extend(credit);
    }
    credits::check(&attribution)?;
    let osm = corniche_spec::inputs::extract_names(&args.osm)?;
    let areas = area_table(&args.areas, &osm)?;
    let lines = lines(&args.areas, &osm)?;
    let cut = Cut {
        bounds_deg: bounds_deg(terrain.bounds, &osm)?.or(base.terrain.plan.bounds_deg),
        polygon: args.polygon.map(polygon).transpose()?,
    };
    let plan = PlanSettings {
        dem: corniche_spec::inputs::elevation_names(&args.dem)?,
        terrain_of: args.terrain_of,
        osm,
        areas,
        lines,
        photo,
        attribution,
        terrain: terrain_settings(terrain, base.terrain, cut, args.force)?,
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

/// The name of an input for GDAL and for plans.
fn input_name(path: PathBuf) -> Result<PathBuf, Failure> {
    corniche_spec::inputs::input_name(path).map_err(Failure::unusable)
}

/// Reads a polygon.
pub(crate) fn polygon(path: PathBuf) -> Result<Polygon, Failure> {
    let read = Polygon::read(&input_name(path)?);
    read.map_err(|error| Failure::new(ExitCode::Unusable, error))
}

/// Which part of the data is wanted.
struct Cut {
    bounds_deg: Option<[f64; 4]>,
    polygon: Option<Polygon>,
}

/// Terrain settings where none is given.
fn usual_terrain() -> TerrainRecord {
    let plan = PlanOptions { fill_voids: FILL_VOIDS, ..PlanOptions::default() };
    TerrainRecord {
        terrain: TerrainSettings { plan, relief: ReliefLevels::Full, ..TerrainSettings::default() },
        attribution: Vec::new(),
    }
}

/// The bounds in degrees, which an extract may have to tell.
fn bounds_deg(bounds: Option<BoundsChoice>, osm: &[PathBuf]) -> Result<Option<[f64; 4]>, Failure> {
    match bounds {
        None => Ok(None),
        Some(BoundsChoice::Degrees(bounds_deg)) => Ok(Some(bounds_deg)),
        Some(BoundsChoice::Osm) if !osm.is_empty() => Ok(Some(corniche_spec::extract_bounds(osm)?)),
        Some(BoundsChoice::Osm) => Err(Failure::unusable(
            "--bounds osm takes the bounds of the extract; give one with --osm",
        )),
    }
}

/// The settings that are given; others are those of `base`.
fn terrain_settings(
    options: TerrainOptions,
    base: TerrainSettings,
    cut: Cut,
    force: bool,
) -> Result<TerrainSettings, Failure> {
    check_nodata(&options.nodata)?;
    if let Some([low, high]) = options.height_range.filter(|ends| !is_range(*ends)) {
        return Err(Failure::unusable(format!(
            "height-range must be the lowest and the highest height, in this order, not {low}, {high}; write it like [-500, 9000]"
        )));
    }
    let cell = options.cell.map(check_cell).transpose();
    let cell = cell.map_err(|error| Failure::unusable(format!("cell: {error}")))?;
    Ok(TerrainSettings {
        open: OpenOptions {
            band: options.dem_band.or(base.open.band),
            dem_crs: options.dem_crs.or(base.open.dem_crs),
            vertical_unit: options.vertical_unit.or(base.open.vertical_unit),
            nodata: if options.nodata.is_empty() { base.open.nodata } else { options.nodata },
            dem_vertical_crs: options.dem_vertical_crs.or(base.open.dem_vertical_crs),
            vertical_crs: options.vertical_crs.or(base.open.vertical_crs),
            vertical_shift_m: options.vertical_shift.unwrap_or(base.open.vertical_shift_m),
        },
        plan: PlanOptions {
            crs: options.crs.or(base.plan.crs),
            cell: cell.map(Cell::from).or(base.plan.cell),
            cell_every: options.cell_every.or(base.plan.cell_every),
            scale_latitude_deg: options.scale_latitude.or(base.plan.scale_latitude_deg),
            fill_voids: options.fill_voids.unwrap_or(base.plan.fill_voids),
            bounds_deg: cut.bounds_deg,
            polygon: cut.polygon,
        },
        height_range_m: options.height_range.or(base.height_range_m),
        allow_fine_cell: force,
        allow_ballpark: options.allow_ballpark,
        max_error_m: positive("--max-error", options.max_error)?.or(base.max_error_m),
        relief: options.relief.map_or(base.relief, relief_levels),
    })
}

/// What `--relief` asks for.
fn relief_levels(choice: ReliefChoice) -> ReliefLevels {
    match choice {
        ReliefChoice::Off => ReliefLevels::Off,
        ReliefChoice::Finest => ReliefLevels::Finest,
        ReliefChoice::Full => ReliefLevels::Full,
    }
}

/// Which photos the package gets, and how they are made.
fn photo_choice(names: &[PathBuf], options: &PhotoOptions) -> Result<PhotoChoice, Failure> {
    // A settings file may say how photos are made that the command line does not want.
    if is_photo_off(names) {
        return Ok(PhotoChoice::Off);
    }
    if names.is_empty() {
        return if options.is_empty() {
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
    let mut wanted = Vec::new();
    for layer in ClassedLayer::ALL {
        let name = layer.name();
        match options.lines(layer) {
            None | Some("off") => {}
            Some("on") if osm.is_empty() => {
                return Err(Failure::unusable(format!(
                    "--{name} takes {name} from an extract; give one with --osm"
                )));
            }
            Some("on") => wanted.push(layer),
            Some(other) => {
                return Err(Failure::unusable(format!("{name} is on or off, not {other:?}")));
            }
        }
    }
    Ok(wanted)
}

fn road_settings(options: RoadOptions) -> Result<RoadSettings, Failure> {
    let simplify_cells = options.simplify.unwrap_or(SIMPLIFY_CELLS);
    if !(0.0..=64.0).contains(&simplify_cells) {
        return Err(Failure::unusable(format!(
            "--simplify must be between 0 and 64 cells, not {simplify_cells}"
        )));
    }
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
    let spans = match options.structures.as_deref() {
        None | Some("spans") => true,
        Some("ground") => false,
        Some(other) => {
            return Err(Failure::unusable(format!(
                "structures must be \"ground\" or \"spans\", not {other:?}"
            )));
        }
    };
    Ok(RoadSettings { table, filter, simplify_cells, spans })
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
        Some(text) => {
            parse_memory(text).map_err(|error| Failure::unusable(format!("--memory {error}")))?
        }
        None => corniche_spec::machine::default_memory_bytes(),
    };
    Ok(Resources { threads: threads(threads_asked), memory_bytes })
}

fn positive(option: &str, value: Option<f64>) -> Result<Option<f64>, Failure> {
    match value {
        Some(metres) if !(metres > 0.0 && metres.is_finite()) => Err(Failure::unusable(format!(
            "{option} must be a positive number of metres, not {metres}"
        ))),
        value => Ok(value),
    }
}

/// The number of threads that is asked for, else one per processor.
pub(crate) fn threads(asked: Option<NonZeroUsize>) -> usize {
    asked.or_else(|| thread::available_parallelism().ok()).map_or(1, NonZeroUsize::get)
}

/// Values that mean "no data" are numbers, and not too many.
fn check_nodata(values: &[f64]) -> Result<(), Failure> {
    if let Some(value) = values.iter().find(|value| !value.is_finite()) {
        return Err(Failure::unusable(format!(
            "--nodata {value} is not needed: a value that is not a finite number is never taken for a height; leave it out"
        )));
    }
    if values.len() > MAX_NODATA {
        return Err(Failure::unusable(format!(
            "--nodata is given {} times, more than {MAX_NODATA}; convert the files so that they say themselves what \
             means \"no data\" (gdal_translate -a_nodata)",
            values.len()
        )));
    }
    Ok(())
}

#[cfg(test)]
#[path = "settings_tests.rs"]
mod tests;
