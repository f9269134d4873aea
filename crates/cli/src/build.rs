//! `corniche build`: turns text into checked settings, then runs the pipeline.

use std::{
    num::NonZeroUsize,
    path::{Path, PathBuf},
    thread,
};

use corniche_geom::Cell;
use corniche_pipeline::{
    BuildError, BuildSettings, Existing, OpenOptions, PlanOptions, Resources, RoadSettings,
    TerrainSettings,
};
use corniche_presets::{
    Config, ResourceOptions, RoadOptions, TerrainOptions, check_cell, class_filter, is_range,
    parse_memory,
};
use corniche_roads::ClassFilter;
use corniche_tileset::Manifest;

use crate::{
    args::BuildArgs,
    defects::{DefectList, Watch},
    exit::ExitCode,
    failure::Failure,
    info, output, presets,
    progress::Progress,
};

/// Default tolerance of the simplification of roads, in cells of the level. It equals the default vertical tolerance, a
/// quarter of the cell, because an error that is too small to be seen in height is too small in plan as well.
const SIMPLIFY_CELLS: f64 = 0.25;
/// Default distance over which voids are filled, in cells.
const FILL_VOIDS: u32 = 32;
/// Default memory for buffers and caches.
const MEMORY_BYTES: u64 = 1 << 30;
/// The most values for "no data" that a package's manifest may list.
const MAX_NODATA: usize = 64;

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
    // A list is put in its place only if it is complete. That is so after a run that failed because no road was kept: all
    // roads were looked at, and the list tells why they were lost.
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
    watch.progress.tell_costs();
    Ok(ExitCode::Done)
}

/// Warnings are printed with `--quiet`, too.
fn tell_warnings(manifest: &Manifest, as_json: bool) {
    for warning in info::warnings(manifest) {
        if as_json {
            eprintln!("{}", serde_json::json!({ "warning": warning }));
        } else {
            eprintln!("corniche: warning: {warning}");
        }
    }
}

/// The only place where text becomes settings. The command line has precedence over the settings file, which has precedence
/// over the defaults.
fn settings(args: BuildArgs) -> Result<BuildSettings, Failure> {
    let config = match &args.config {
        Some(path) => presets::read_config(path)?,
        None => Config::default(),
    };
    let terrain = args.terrain.or(config.terrain);
    let roads = args.roads.or(config.roads);
    let resources = args.resources.or(config.resources);
    Ok(BuildSettings {
        dem: args.dem,
        osm: args.osm,
        output: args.output,
        existing: if args.overwrite { Existing::Replace } else { Existing::Keep },
        tmp: None,
        leftovers: if args.overwrite { corniche_pipeline::Leftovers::Discard } else { corniche_pipeline::Leftovers::Refuse },
        force: false,
        attribution: if args.attribution.is_empty() {
            terrain.attribution.clone()
        } else {
            args.attribution
        },
        terrain: terrain_settings(terrain)?,
        roads: road_settings(roads)?,
        resources: resource_settings(&resources)?,
        generator: format!("corniche {}", env!("CARGO_PKG_VERSION")),
    })
}

fn terrain_settings(options: TerrainOptions) -> Result<TerrainSettings, Failure> {
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
            dem_crs: options.dem_crs,
            nodata: options.nodata,
            dem_vertical_crs: options.dem_vertical_crs,
            vertical_crs: options.vertical_crs,
            vertical_shift_m: options.vertical_shift.unwrap_or(0.0),
        },
        plan: PlanOptions {
            crs: options.crs,
            cell: cell.map(Cell::from),
            cell_every: options.cell_every,
            scale_latitude_deg: options.scale_latitude,
            fill_voids: options.fill_voids.unwrap_or(FILL_VOIDS),
        },
        height_range_m: options.height_range,
        allow_fine_cell: options.force,
        max_error_m: positive("--max-error", options.max_error)?,
    })
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
    Ok(RoadSettings { table, filter, simplify_cells })
}

fn resource_settings(options: &ResourceOptions) -> Result<Resources, Failure> {
    let memory_bytes = match &options.memory {
        Some(text) => {
            parse_memory(text).map_err(|error| Failure::unusable(format!("--memory {error}")))?
        }
        None => MEMORY_BYTES,
    };
    Ok(Resources { threads: threads(options.threads), memory_bytes })
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
#[path = "build_tests.rs"]
mod tests;
