//! `corniche build`: from text to settings once, then the pipeline.

use std::{
    num::NonZeroUsize,
    path::{Path, PathBuf},
    thread,
};

use corniche_geom::Cell;
use corniche_pipeline::{
    BuildError, BuildSettings, Existing, Resources, RoadSettings, TerrainSettings,
};
use corniche_presets::{Config, class_filter};
use corniche_roads::ClassFilter;
use corniche_tileset::Manifest;

use crate::{
    args::{BuildArgs, check_cell, parse_bytes},
    defects::{DefectList, Watch},
    exit::ExitCode,
    failure::Failure,
    info, output, presets,
    progress::Progress,
};

/// Tolerance of the simplification of roads, in cells of the level, unless said otherwise. It matches the
/// vertical tolerance, a quarter of the cell: what cannot be seen upright cannot be seen in plan.
const SIMPLIFY_CELLS: f64 = 0.25;
/// How far voids are filled, in cells, unless said otherwise.
const FILL_VOIDS: u32 = 32;
/// Memory for buffers and caches unless said otherwise.
const MEMORY_BYTES: u64 = 1 << 30;
/// As many values for "no data" as a package's manifest may list.
const MAX_NODATA: usize = 64;
/// With less than this the stages cannot hold a tile each.
const MIN_MEMORY_BYTES: u64 = 64 << 20;

pub(crate) fn run(args: Box<BuildArgs>) -> Result<ExitCode, Failure> {
    output::writable(&args.output)?;
    let progress = Progress::new(&args.report);
    let is_json = args.report.json_progress;
    let quiet = args.report.quiet || is_json;
    let defects = match &args.defects {
        Some(path) => {
            let existing =
                if args.overwrite { output::Existing::Replace } else { output::Existing::Keep };
            let mut others: Vec<&Path> = args.dem.iter().map(PathBuf::as_path).collect();
            others.extend(args.osm.as_deref());
            others.extend(args.config.as_deref());
            others.push(&args.output);
            Some(DefectList::create(path, existing, &others)?)
        }
        None => None,
    };
    let watch = Watch { progress, defects };
    let settings = settings(*args)?;
    let built = corniche_pipeline::build(&settings, &watch);
    // A list stands at its place only if it is complete. Of a run that failed it is where all roads were looked at, and
    // there it tells why.
    let is_complete = match &built {
        Ok(_) | Err(BuildError::NoRoads { .. } | BuildError::NoGround { .. }) => true,
        Err(_) => false,
    };
    let listed = watch.defects.filter(|_| is_complete).map_or(Ok(()), DefectList::finish);
    let summary = built?;
    listed?;
    if quiet {
        tell_warnings(&summary.manifest, is_json);
    } else {
        eprintln!("\n{}", info::to_text(&summary.manifest, summary.package_bytes));
        eprintln!("wrote {}", settings.output.display());
    }
    Ok(ExitCode::Done)
}

/// Warnings are told to whoever asked for silence too.
fn tell_warnings(manifest: &Manifest, as_json: bool) {
    for warning in info::warnings(manifest) {
        if as_json {
            eprintln!("{}", serde_json::json!({ "warning": warning }));
        } else {
            eprintln!("corniche: warning: {warning}");
        }
    }
}

/// The only way from text to settings: command line before settings file before defaults.
fn settings(args: BuildArgs) -> Result<BuildSettings, Failure> {
    let config = match &args.config {
        Some(path) => presets::read_config(path)?,
        None => Config::default(),
    };
    let nodata = nodata(args.terrain.nodata, config.terrain.nodata)?;
    let height_range_m = args.terrain.height_range.or(config.terrain.height_range);
    if let Some([low, high]) =
        height_range_m.filter(|[low, high]| !(low < high && (high - low).is_finite()))
    {
        return Err(Failure::unusable(format!(
            "height-range of {low}, {high} has no two ends in order; write it like [-500, 9000]"
        )));
    }
    // Two ways to say one thing: what the command line says of it goes before all that the file says.
    let (cell, cell_every) = match (args.terrain.cell, args.terrain.cell_every) {
        (None, None) => {
            let cell = config.terrain.cell.map(|sides| check_cell(sides.to_array())).transpose();
            let cell = cell.map_err(|error| Failure::unusable(format!("cell: {error}")))?;
            (cell, config.terrain.cell_every)
        }
        said => said,
    };
    let terrain = TerrainSettings {
        crs: args.terrain.crs.or(config.terrain.crs),
        dem_crs: args.terrain.dem_crs.or(config.terrain.dem_crs),
        dem_vertical_crs: args.terrain.dem_vertical_crs.or(config.terrain.dem_vertical_crs),
        vertical_crs: args.terrain.vertical_crs.or(config.terrain.vertical_crs),
        vertical_shift_m: args
            .terrain
            .vertical_shift
            .or(config.terrain.vertical_shift)
            .unwrap_or(0.0),
        nodata,
        height_range_m,
        allow_fine_cell: args.terrain.force,
        cell: cell.map(Cell::from),
        cell_every,
        scale_latitude_deg: args.terrain.scale_latitude.or(config.terrain.scale_latitude),
        max_error_m: positive("--max-error", args.terrain.max_error.or(config.terrain.max_error))?,
        fill_voids: args.terrain.fill_voids.or(config.terrain.fill_voids).unwrap_or(FILL_VOIDS),
    };
    let simplify_cells = args.roads.simplify.or(config.roads.simplify).unwrap_or(SIMPLIFY_CELLS);
    if !(0.0..=64.0).contains(&simplify_cells) {
        return Err(Failure::unusable(format!(
            "--simplify must be between 0 and 64 cells, not {simplify_cells}"
        )));
    }
    let filter = if args.roads.all_classes || config.roads.all_classes {
        ClassFilter::all()
    } else {
        match config.roads.class_max_cell {
            Some(cells) => {
                class_filter(&cells).map_err(|error| presets::refuse("settings", &error))?
            }
            None => ClassFilter::usual(),
        }
    };
    let table = args.roads.frc_table.or(config.roads.frc_table);
    let memory = args.resources.memory.or(config.resources.memory);
    Ok(BuildSettings {
        dem: args.dem,
        osm: args.osm,
        output: args.output,
        existing: if args.overwrite { Existing::Replace } else { Existing::Keep },
        terrain,
        attribution: if args.attribution.is_empty() {
            config.terrain.attribution
        } else {
            args.attribution
        },
        roads: RoadSettings {
            table: presets::frc_table(table.as_deref().unwrap_or("default"))?,
            filter,
            simplify_cells,
        },
        resources: Resources {
            threads: threads(args.resources.threads.or(config.resources.threads)),
            memory_bytes: memory.as_deref().map_or(Ok(MEMORY_BYTES), parse_memory)?,
        },
        generator: format!("corniche {}", env!("CARGO_PKG_VERSION")),
    })
}

fn positive(option: &str, value: Option<f64>) -> Result<Option<f64>, Failure> {
    match value {
        Some(metres) if !(metres > 0.0 && metres.is_finite()) => Err(Failure::unusable(format!(
            "{option} must be a positive number of metres, not {metres}"
        ))),
        value => Ok(value),
    }
}

/// As many threads as asked for, else one per processor.
pub(crate) fn threads(asked: Option<NonZeroUsize>) -> usize {
    asked.or_else(|| thread::available_parallelism().ok()).map_or(1, NonZeroUsize::get)
}

/// What `--memory` says, if it is enough to work in.
fn parse_memory(text: &str) -> Result<u64, Failure> {
    match parse_bytes(text) {
        Ok(size_bytes) if size_bytes >= MIN_MEMORY_BYTES => Ok(size_bytes),
        _ => Err(Failure::unusable(format!(
            "--memory {text:?} is not a size of at least 64M; write it like 512M, 4G or 1T"
        ))),
    }
}

/// Values that mean "no data": the command line's, else the settings file's.
fn nodata(given: Vec<f64>, config: Vec<f64>) -> Result<Vec<f64>, Failure> {
    let values = if given.is_empty() { config } else { given };
    if let Some(value) = values.iter().find(|value| !value.is_finite()) {
        return Err(Failure::unusable(format!(
            "--nodata {value} is needless: what is no finite number is no height anyway; leave it out"
        )));
    }
    if values.len() > MAX_NODATA {
        return Err(Failure::unusable(format!(
            "--nodata is given {} times, more than {MAX_NODATA}; convert the files so that they say themselves what \
             means \"no data\" (gdal_translate -a_nodata)",
            values.len()
        )));
    }
    Ok(values)
}

#[cfg(test)]
#[path = "build_tests.rs"]
mod tests;
