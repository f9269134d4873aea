//! From inputs to a package: the steps in order, and the file's way to its place.
//!
//! ```text
//!  hashes   roads ────────┐
//!  heights ─► tiles ──────┴─► merge ─► package
//! ```
//!
//! Where the terrain comes from a package, the step *heights* reads photos alone, and the tiles are made from those of the package.
//!
//! Each step is a module of [`steps`](crate::steps). What one step hands to the next are artifacts in a store beside the target.

pub(crate) mod destination;
pub(crate) mod work_store;

use std::{sync::Arc, time::Duration};

use corniche_dem::GridPlan;
use corniche_geom::TileId;
use corniche_gis::DatumOperation;
use corniche_ground::terrain::ground::GroundSource;
use corniche_plan::{BuildPlan, Opened, check_room, network_differences};
use corniche_spec::{
    BuildSettings, Observer, PlanSettings, TerrainSettings, memory_shares::MemoryShares,
    settings_record,
};
use corniche_store::{Disk, LocalStore, SYNC_INTERVAL, SystemDisk};
use corniche_tileset::Manifest;

use self::destination::Destination;
use crate::{
    BuildError,
    context::Context,
    steps::{hashes, heights, merge, roads, tiles, top},
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
/// Intermediate results are kept in a store beside the package, or in `settings.tmp`. When the build is interrupted or the disk
/// fails, they stay, and a build with [`Leftovers::Resume`](corniche_spec::Leftovers::Resume) goes on from them.
///
/// # Errors
/// See [`BuildError`].
pub fn build(
    settings: &BuildSettings,
    observer: &dyn Observer,
) -> Result<BuildSummary, BuildError> {
    let disk: Arc<dyn Disk> = Arc::new(SystemDisk);
    build_on(&disk, SYNC_INTERVAL, settings, observer)
}

/// Does the same as [`build`] with the store on any disk, made durable as often as wanted: tests let it fail.
#[doc(hidden)]
pub fn build_on(
    disk: &Arc<dyn Disk>,
    sync_interval: Duration,
    settings: &BuildSettings,
    observer: &dyn Observer,
) -> Result<BuildSummary, BuildError> {
    let destination = Destination::of(&settings.output, settings.existing)?;
    destination.refuse_inputs(&settings.plan)?;
    MemoryShares::limit_raster_cache(settings.resources)?;
    let opened = Opened::new(&settings.plan)?;
    let plan = BuildPlan::of(&settings.plan, &opened)?;
    let store_folder = work_store::folder_of(&destination.target, settings.tmp.as_deref());
    // Before the store is looked at: what another build is at work on is no leftover.
    let claim = destination.claim(observer)?;
    let held_bytes = work_store::look(disk, &store_folder, &plan, settings.leftovers)?;
    if !settings.force {
        let folder = &*destination.folder;
        let store = settings.tmp.as_deref().unwrap_or(folder);
        check_room(&opened, settings.resources, [store, folder], held_bytes, observer)?;
    }
    let place = (disk, &*store_folder, sync_interval);
    let store = work_store::open(place, &plan, settings.leftovers, observer)?;
    observer.keeps(&store_folder);
    let finished = destination.begin(claim)?;
    let finished_path = finished.path().to_path_buf();
    let context = Context::new(&settings.plan, settings.resources, &opened, &store, observer);
    let wanted = merge::Target { finished: &finished_path, named: &settings.output };
    let built = run(&context, &store, &wanted)
        .and_then(|manifest| Ok((manifest, destination::place(finished)?)));
    match built {
        Ok((manifest, package_bytes)) => {
            work_store::remove(store, observer);
            Ok(BuildSummary { manifest, package_bytes })
        }
        Err(error) => {
            // A changed input may be the cause of any other error, so it is reported instead.
            let error = match error {
                BuildError::Interrupted => BuildError::Interrupted,
                error => opened.inputs.changed_instead_of(error),
            };
            work_store::after_failure(store, &store_folder, &plan, &error, observer);
            Err(error)
        }
    }
}

/// Warns of what a user may not have meant, before any work.
pub(crate) fn warn(context: &Context<'_>) {
    warn_of_other_grids(context.grid, context.observer);
    if let GroundSource::Dem(dem) = context.source {
        let of_datums = context.grid.datum_operations.iter().filter_map(DatumOperation::warning);
        for text in of_datums.chain(dem.unit_warning()) {
            context.observer.warning(&text);
        }
    }
    context.opened.file_datums.warnings().for_each(|text| context.observer.warning(&text));
    warn_of_unused_latitude(&context.settings.terrain, context.grid, context.observer);
    warn_of_other_network(context);
}

/// Warns if the package that gives the terrain has roads or areas that were made with other settings: who brings new ones onto it each
/// week may have forgotten an option.
fn warn_of_other_network(context: &Context<'_>) {
    let GroundSource::Package(terrain) = context.source else { return };
    let PlanSettings { terrain: of_terrain, roads, areas, lines, osm, .. } = context.settings;
    let manifest = terrain.manifest();
    if osm.is_empty() || !manifest.has_extract() {
        return;
    }
    let ours = settings_record::of(
        of_terrain,
        roads,
        context.opened.max_error_m,
        None,
        (areas.as_ref(), lines),
    );
    let differences = network_differences(&ours, &manifest.settings);
    if !differences.is_empty() {
        context.observer.warning(&format!(
            "roads and areas are made with other settings than those of {}: {}",
            terrain.path().display(),
            differences.join("; ")
        ));
    }
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

/// All steps in order; the package is written to `finished`.
fn run(
    context: &Context<'_>,
    store: &LocalStore,
    target: &merge::Target<'_>,
) -> Result<Manifest, BuildError> {
    warn(context);
    hashes::make(context)?;
    // Roads come before the long work on heights, so that an unusable extract is reported at once.
    // Scratch space is given back when a step ends, and what the step made is durable.
    roads::make(context, &store.scratch()?)?;
    store.flush()?;
    heights::make(context, TileId::ROOT)?;
    top::make(context)?;
    tiles::make(context, TileId::ROOT)?;
    store.flush()?;
    merge::make(context, &store.scratch()?, target)
}
