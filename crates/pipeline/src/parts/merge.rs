//! Writes the package from all parts.

use std::path::PathBuf;

use corniche_geom::TileId;
use corniche_ground::terrain::ground::GroundSource;
use corniche_objects::StorageRequests;
use corniche_pieces::layers::defects::replay_defects;
use corniche_plan::BuildPlan;
use corniche_spec::{BuildObserver, Resources};
use corniche_store::{Existing, LocalStore};
use corniche_tileset::Manifest;

use super::{needed_parts::is_merged, package::PackageDestination, planned::open, stores::Stores};
use crate::{
    BuildError, BuildSummary,
    build::destination,
    context::BuildContext,
    objects::ObjectAccess,
    steps::{coarse_tiles, merge as sums, recorded_tiles},
};

/// The part that holds the results of a merge while it runs.
const OWN_PART: &str = "merge";

/// The settings of a merge.
#[derive(Debug, Clone)]
pub struct MergeSettings {
    /// The plan of the build.
    pub plan: BuildPlan,
    /// Folders of parts, or addresses in object storage. If the first one is a folder, it also
    /// holds intermediate results while the merge runs.
    pub stores: Vec<PathBuf>,
    /// The folder for intermediate results otherwise, and for a package that is then uploaded to
    /// object storage; `None`: the system's temporary folder.
    pub tmp: Option<PathBuf>,
    /// The package to write: a file, or an address in object storage.
    pub output: PathBuf,
    /// What to do when the package exists.
    pub existing: Existing,
    /// The resources that the run may use.
    pub resources: Resources,
    /// Program and version. It must be the program that created the plan.
    pub generator: String,
}

/// The result of a merge.
#[derive(Debug, Clone)]
pub struct MergeSummary {
    /// The package.
    pub package: BuildSummary,
    /// Requests to object storage; `None` if neither a store nor the package is there.
    pub requests: Option<StorageRequests>,
}

/// Writes the package of a plan from its parts: the same bytes as [`build`](crate::build) with the
/// plan's settings. The stores remain unchanged.
///
/// # Errors
/// See [`BuildError`]; [`BuildError::Artifact`] if a part is missing.
pub fn merge(
    settings: &MergeSettings,
    observer: &dyn BuildObserver,
) -> Result<MergeSummary, BuildError> {
    let MergeSettings { plan, stores, tmp, output, existing, resources, generator } = settings;
    let mut access = ObjectAccess::new(*resources);
    let place = PackageDestination::resolve(output, *existing, tmp.as_deref(), &mut access)?;
    let destination = &place.destination;
    let stores = Stores::look(stores, tmp.as_deref(), plan, access, false)?;
    let (plan_settings, opened) = open(plan, generator, *resources)?;
    place.refuse_inputs(&plan_settings, &settings.stores)?;
    let finished = destination.begin(destination.claim(observer)?)?;
    let open_stores = stores.open(OWN_PART, &is_merged)?;
    let store = &open_stores.store;
    let context = BuildContext::new(&plan_settings, *resources, &opened, store, observer);
    let wanted = sums::MergeTarget { finished: finished.path(), named: output };
    let merged = run(&context, store, &wanted)
        .and_then(|manifest| Ok((manifest, destination::place(finished)?)));
    let abandoned = open_stores.abandon();
    let (manifest, package_bytes) = merged.map_err(|error| {
        // A changed input may be the cause of any other error, so it is reported instead.
        opened.inputs.changed_instead_of(error)
    })?;
    if let Err(error) = abandoned {
        observer.warning(&format!("intermediate results were not removed: {error}"));
    }
    place.send(observer)?;
    let package = BuildSummary { manifest, package_bytes };
    Ok(MergeSummary { package, requests: stores.requests() })
}

fn run(
    context: &BuildContext<'_>,
    store: &LocalStore,
    target: &sums::MergeTarget<'_>,
) -> Result<Manifest, BuildError> {
    sums::check_complete(context)?;
    if let GroundSource::Package(terrain) = context.source {
        // These are the tiles above the subtrees.
        recorded_tiles::make(context, terrain, TileId::ROOT)?;
    }
    if !context.settings.osm.is_empty() {
        replay_defects(context.store, context.observer)?;
    }
    coarse_tiles::make(context, TileId::ROOT)?;
    sums::make(context, &store.scratch()?, target)
}
