//! Builds a package from inputs: the steps in order, and moving the finished file to its path.
//!
//! ```text
//!  hashes   roads ────────┐
//!  heights ─► tiles ──────┴─► merge ─► package
//! ```
//!
//! If the terrain comes from a package, the step *heights* reads only photos, and the tiles are
//! built from those of the package.
//!
//! Each step is a module of [`steps`](crate::steps). Steps pass their results on as artifacts in a
//! store next to the target.

pub(crate) mod destination;
pub(crate) mod work_store;

use std::{sync::Arc, time::Duration};

use corniche_geom::TileId;
use corniche_gis::DatumOperation;
use corniche_ground::terrain::ground::GroundSource;
use corniche_plan::{BuildPlan, Opened, check_room, network_differences};
use corniche_spec::{BuildObserver, BuildSettings, memory_shares::MemoryShares, settings_record};
use corniche_store::{Disk, LocalStore, SYNC_INTERVAL, SystemDisk};
use corniche_tileset::Manifest;

use self::destination::Destination;
use crate::{
    BuildError,
    context::BuildContext,
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

/// Builds a package. The target path always holds the old file or the complete new package.
///
/// Intermediate results are stored next to the package, or in `settings.tmp`. When the build is
/// interrupted or the disk fails, they are preserved, and a build with
/// [`Leftovers::Resume`](corniche_spec::Leftovers::Resume) continues from them.
///
/// # Errors
/// See [`BuildError`].
pub fn build(
    settings: &BuildSettings,
    observer: &dyn BuildObserver,
) -> Result<BuildSummary, BuildError> {
    let disk: Arc<dyn Disk> = Arc::new(SystemDisk);
    build_on(&disk, SYNC_INTERVAL, settings, observer)
}

/// Builds as [`build`] does, with the store on any disk and synced at any interval: tests let the
/// disk fail.
#[doc(hidden)]
pub fn build_on(
    disk: &Arc<dyn Disk>,
    sync_interval: Duration,
    settings: &BuildSettings,
    observer: &dyn BuildObserver,
) -> Result<BuildSummary, BuildError> {
    let destination = Destination::resolve(&settings.output, settings.existing)?;
    destination.refuse_inputs(&settings.plan)?;
    MemoryShares::limit_raster_cache(settings.resources)?;
    let opened = Opened::new(&settings.plan)?;
    let plan = BuildPlan::from_settings(&settings.plan, &opened)?;
    let store_folder = work_store::folder_of(&destination.target, settings.tmp.as_deref());
    // The claim comes before the check of the store: the store of another running build is not a
    // leftover.
    let claim = destination.claim(observer)?;
    let held_bytes = work_store::look(disk, &store_folder, &plan, settings.leftovers)?;
    if !settings.force {
        let folder = &*destination.folder;
        let store = settings.tmp.as_deref().unwrap_or(folder);
        check_room(&opened, settings.resources, [store, folder], held_bytes, observer)?;
    }
    let leftovers = settings.leftovers;
    let store = work_store::open(disk, &store_folder, sync_interval, &plan, leftovers, observer)?;
    observer.keeps(&store_folder);
    let finished = destination.begin(claim)?;
    let finished_path = finished.path().to_path_buf();
    let context = BuildContext::new(&settings.plan, settings.resources, &opened, &store, observer);
    let wanted = merge::MergeTarget { finished: &finished_path, named: &settings.output };
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

/// Warns of settings that the user may not have intended, before any work.
pub(crate) fn warn(context: &BuildContext<'_>) {
    let BuildContext { settings, opened, source, grid, observer, .. } = *context;
    if let Some([files, first]) = &grid.resampled_onto_first {
        observer.warning(&format!(
            "{files}: samples are not on the grid of {first}, the first file named; they are resampled onto its grid"
        ));
    }
    if let GroundSource::Dem(dem) = source {
        let of_datums = grid.datum_operations.iter().filter_map(DatumOperation::warning);
        of_datums.chain(dem.unit_warning()).for_each(|text| observer.warning(&text));
    }
    opened.file_datums.warnings().for_each(|text| observer.warning(&text));
    let latitude_deg = settings.terrain.plan.scale_latitude_deg;
    if let Some(latitude_deg) = latitude_deg.filter(|_| !grid.has_standard_latitude()) {
        observer.warning(&format!(
            "--scale-latitude {latitude_deg} has no effect: lengths in {} are not rescaled",
            grid.crs
        ));
    }
    // Users who put new roads on a package's terrain each week may have forgotten an option.
    if let GroundSource::Package(terrain) = source
        && !settings.osm.is_empty()
        && terrain.manifest().has_extract()
    {
        let ours = settings_record::record_settings(settings, opened.max_error_m, None);
        let differences = network_differences(&ours, &terrain.manifest().settings);
        if !differences.is_empty() {
            observer.warning(&format!(
                "roads and layers are built with settings that differ from those of {:?}: {}",
                terrain.path(),
                differences.join("; ")
            ));
        }
    }
}

/// Runs all steps in order; the package is written to `finished`.
fn run(
    context: &BuildContext<'_>,
    store: &LocalStore,
    target: &merge::MergeTarget<'_>,
) -> Result<Manifest, BuildError> {
    warn(context);
    hashes::make(context)?;
    // Roads come before the long work on heights, so that an unusable extract is reported at once.
    // A step releases its scratch space when it ends, and its results are durable.
    roads::make(context, &store.scratch()?)?;
    store.flush()?;
    heights::make(context, TileId::ROOT)?;
    top::make(context)?;
    tiles::make(context, TileId::ROOT)?;
    store.flush()?;
    merge::make(context, &store.scratch()?, target)
}
