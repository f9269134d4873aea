//! From inputs to a package.
//!
//! ```text
//! heights ─► mesh ─► deviations ─┐
//!                                ├─► tiles ─► package
//! roads ─────────────────────────┘
//! ```
//!
//! Each stage is a module of [`heights`](crate::heights), [`roads`](crate::roads) or [`stages`](crate::stages). What one stage
//! hands to the next is kept in [`Storage`](crate::storage::Storage), in a work folder beside the target. The folder is
//! removed when the run ends, however it ends.

use std::{
    fs,
    path::{Path, PathBuf},
};

use corniche_dem::{DemProjection, GridPlan};
use corniche_tileset::Manifest;

use crate::{
    BuildError, BuildSettings, DiskStorage, Existing, Observer, PlanSettings, Storage,
    TerrainSettings, file_target,
    heights::{audit, pyramid},
    levels::Levels,
    plan::{Opened, check_room},
    roads::{lengths::TrueLengths, losses, read},
    stages::{deviations, mesh, package, samples, tiles},
};

/// The result of a build.
#[derive(Debug, Clone)]
pub struct BuildSummary {
    /// The package's manifest.
    pub manifest: Manifest,
    /// Size of the package.
    pub package_bytes: u64,
}

/// Builds a package. At the target there is either what was there before or the complete package.
///
/// # Errors
/// See [`BuildError`].
pub fn build(
    settings: &BuildSettings,
    observer: &dyn Observer,
) -> Result<BuildSummary, BuildError> {
    let target = &file_target(&settings.output)?;
    let folder = match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let unusable = |source| BuildError::Target { folder: folder.to_path_buf(), source };
    if settings.existing == Existing::Keep && fs::symlink_metadata(target).is_ok() {
        return Err(BuildError::Exists { path: target.clone() });
    }
    refuse_inputs_as_target(settings)?;
    let name =
        target.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    // Beside the target: the same file system, so that the rename at the end is one step.
    let work = tempfile::Builder::new()
        .prefix(&format!(".{name}."))
        .suffix(".work")
        .tempdir_in(folder)
        .map_err(unusable)?;
    observer.work_folder(work.path());
    let storage = DiskStorage::create(work.path()).map_err(unusable)?;
    let finished = work.path().join("package");
    corniche_dem::limit_block_cache(settings.resources.memory_bytes / 4)
        .map_err(|error| not_started(&error))?;
    let opened = Opened::new(&PlanSettings::from(settings))?;
    if !settings.force {
        let store = settings.tmp.as_deref().unwrap_or(folder);
        check_room(&opened, settings.resources, [store, folder], observer)?;
    }
    let manifest = run(settings, &opened, &finished, &storage, observer).map_err(|error| {
        // A changed input may be the cause of any other error, so it is reported instead.
        let changed = match &error {
            BuildError::Interrupted => None,
            _ => opened.inputs.check_unchanged().err(),
        };
        changed.map_or(error, BuildError::from)
    })?;
    let package_bytes = place(&finished, target, settings.existing)?;
    Ok(BuildSummary { manifest, package_bytes })
}

/// Fails if the target is one of the inputs.
fn refuse_inputs_as_target(settings: &BuildSettings) -> Result<(), BuildError> {
    let Ok(target) = fs::canonicalize(&settings.output) else { return Ok(()) };
    for input in settings.dem.iter().chain(&settings.osm) {
        if fs::canonicalize(input).is_ok_and(|input| input == target) {
            return Err(BuildError::TargetIsInput { path: input.clone() });
        }
    }
    Ok(())
}

/// Warns of files that are resampled onto the grid of the first one.
fn warn_of_other_grids(plan: &GridPlan, observer: &dyn Observer) {
    if let Some([files, first]) = &plan.resampled_onto_first {
        observer.warning(&format!(
            "{files}: samples lie on another grid than those of {first}, named first; they are resampled onto its grid"
        ));
    }
}

/// Warns if `--scale-latitude` was given and has no effect.
fn warn_of_unused_latitude(terrain: &TerrainSettings, plan: &GridPlan, observer: &dyn Observer) {
    if let Some(latitude_deg) =
        terrain.plan.scale_latitude_deg.filter(|_| !plan.has_standard_latitude())
    {
        observer.warning(&format!(
            "--scale-latitude {latitude_deg} changes nothing: lengths in {} are taken as they are",
            plan.crs
        ));
    }
}

fn not_started(error: &dyn std::fmt::Display) -> BuildError {
    BuildError::Start { what: error.to_string() }
}

/// The grid that roads are read for.
struct RoadGrid<'a> {
    plan: &'a GridPlan,
    projection: &'a DemProjection,
    levels: &'a Levels,
    lengths: &'a TrueLengths<'a>,
}

/// Reads the extract; fails if none of its roads lies on the elevation data.
fn read_roads<'a>(
    osm: &Path,
    settings: &BuildSettings,
    grid: &RoadGrid<'_>,
    storage: &'a dyn Storage,
    observer: &dyn Observer,
) -> Result<read::ReadRoads<'a>, BuildError> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(settings.resources.threads)
        .build()
        .map_err(|error| not_started(&error))?;
    let input = read::RoadInput {
        osm,
        settings: &settings.roads,
        projection: grid.projection,
        levels: grid.levels,
        lengths: grid.lengths,
        data_bounds: pyramid::data_tile_bounds(grid.plan),
        pool: &pool,
        memory_bytes: settings.resources.memory_bytes / 4,
    };
    let roads = read::read(&input, storage, observer)?;
    read::check_overlap(&roads, &input, grid.plan)?;
    Ok(roads)
}

/// Why no tile has ground.
fn no_mesh(dem: &[PathBuf], pyramid: &pyramid::Pyramid<'_>) -> BuildError {
    let dem = dem.to_vec();
    match pyramid.samples().with_data {
        0 => BuildError::NoHeights { dem },
        nodes => BuildError::NoCell { dem, nodes },
    }
}

/// All stages in order; the package is written to `finished`.
fn run(
    settings: &BuildSettings,
    Opened { inputs, dem, grid: plan, levels, max_error_m, coordinates }: &Opened,
    finished: &Path,
    storage: &dyn Storage,
    observer: &dyn Observer,
) -> Result<Manifest, BuildError> {
    let threads = settings.resources.threads;
    let terrain = &settings.terrain;
    warn_of_other_grids(plan, observer);
    warn_of_unused_latitude(terrain, plan, observer);
    let projection = dem.projection(plan)?;
    let lengths = TrueLengths::new(plan.frame, coordinates, &projection);
    let records = inputs.hash(observer)?;

    // Roads come before the long work on heights, so that an unusable extract is reported at once.
    let data_tiles = pyramid::data_tiles(plan);
    let grid = RoadGrid { plan, projection: &projection, levels, lengths: &lengths };
    let mut roads = match &settings.osm {
        Some(osm) => Some(read_roads(osm, settings, &grid, storage, observer)?),
        None => None,
    };
    audit::check(dem, terrain.height_range_m, threads, observer)?;
    let pyramid = pyramid::read(dem, plan, threads, storage, observer)?;
    let meshes = mesh::mesh(&pyramid, levels, threads, storage, observer)?;
    if meshes.is_empty() {
        return Err(no_mesh(&settings.dem, &pyramid));
    }
    let deviations = deviations::measure(&pyramid, &meshes, levels, threads, storage, observer)?;
    let sample_sums = if plan.nodes_are_samples() {
        deviations.at_nodes().to_vec()
    } else {
        let bytes = settings.resources.memory_bytes / 4 / threads.max(1) as u64;
        let grounds = samples::GroundInput { meshes: &meshes, levels, storage, bytes };
        samples::measure(dem, plan, &grounds, threads, observer)?
    };
    let tiles = tiles::make(
        &tiles::TileInput {
            levels,
            lengths: &lengths,
            meshes: &meshes,
            deviations: &deviations,
            pyramid: &pyramid,
            data_tiles: &data_tiles,
            storage,
            threads,
        },
        roads.as_mut(),
        observer,
    )?;
    if let Some(roads) = &roads {
        losses::report(roads, &tiles.roads, observer)?;
    }
    let manifest = package::manifest(&package::Outcome {
        settings,
        max_error_m: *max_error_m,
        plan,
        levels,
        coordinates,
        inputs: records,
        samples: pyramid.samples(),
        range_m: pyramid.range_m(),
        roads: roads.as_ref(),
        tiles: &tiles,
        deviations: &deviations,
        sample_sums: &sample_sums,
    });
    if let (Some(osm), 0) = (&settings.osm, manifest.counts.roads_kept) {
        return Err(BuildError::NoGround { osm: osm.clone() });
    }
    // All inputs have been read. If none has changed, the recorded hashes are those of the bytes that were used.
    inputs.check_unchanged()?;
    package::write(finished, &settings.output, &manifest, &tiles, storage, observer)?;
    Ok(manifest)
}

/// Writes the finished package's bytes to the disk, then moves the file to its place.
fn place(finished: &Path, target: &Path, existing: Existing) -> Result<u64, BuildError> {
    let failed = |source| BuildError::Rename { path: target.to_path_buf(), source };
    let file = fs::File::options().write(true).open(finished).map_err(failed)?;
    file.sync_all().map_err(failed)?;
    let bytes = file.metadata().map_err(failed)?.len();
    match existing {
        Existing::Replace => fs::rename(finished, target).map_err(failed)?,
        // A link fails where a rename would replace what someone put there while the build ran.
        Existing::Keep => match fs::hard_link(finished, target) {
            Ok(()) => {}
            Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => {
                return Err(BuildError::Exists { path: target.to_path_buf() });
            }
            // Not every file system has hard links. Without them only the check at the start protects an existing file.
            Err(_) => fs::rename(finished, target).map_err(failed)?,
        },
    }
    Ok(bytes)
}
