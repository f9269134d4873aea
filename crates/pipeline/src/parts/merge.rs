//! The package from all parts.

use std::path::PathBuf;

use corniche_geom::TileId;
use corniche_store::LocalStore;
use corniche_tileset::Manifest;

use super::{needed_parts::is_merged, planned::open, stores::Stores};
use crate::{
    BuildError, BuildPlan, BuildSummary, Existing, Observer, Resources,
    build::{destination::Destination, unfinished::Unfinished},
    context::Context,
    roads::partition::replay_defects,
    steps::{coarse_tiles, merge as sums, recorded_tiles},
    terrain::ground::GroundSource,
};

/// The part that holds what a merge makes, while it runs.
const OWN_PART: &str = "merge";

/// What to merge.
#[derive(Debug, Clone)]
pub struct MergeSettings {
    /// What is built.
    pub plan: BuildPlan,
    /// Folders of parts. The first also holds intermediate results while the merge runs.
    pub stores: Vec<PathBuf>,
    /// The package to write.
    pub output: PathBuf,
    /// What to do when the package exists.
    pub existing: Existing,
    /// What the run may use.
    pub resources: Resources,
    /// Program and version. It must be the one that made the plan.
    pub generator: String,
}

/// Writes the package of a plan from its parts: the same bytes as [`build`](crate::build) with the plan's settings. The stores stay as
/// they are.
///
/// # Errors
/// See [`BuildError`]; [`BuildError::Missing`] if a part is not there.
pub fn merge(
    settings: &MergeSettings,
    observer: &dyn Observer,
) -> Result<BuildSummary, BuildError> {
    let MergeSettings { plan, stores, output, existing, resources, generator } = settings;
    let destination = Destination::of(output, *existing)?;
    let stores = Stores::look(stores, plan, false)?;
    let (plan_settings, opened) = open(plan, generator, *resources)?;
    destination.refuse_inputs(&plan_settings)?;
    let finished = Unfinished::create(&destination)?;
    observer.temporary(finished.path());
    let store = stores.open(OWN_PART, &is_merged)?;
    let context = Context::new(&plan_settings, *resources, &opened, &store, observer);
    let wanted = sums::Target { finished: finished.path(), named: output };
    let merged = run(&context, &store, &wanted)
        .and_then(|manifest| Ok((manifest, finished.place(&destination)?)));
    let abandoned = store.abandon();
    let (manifest, package_bytes) = merged.map_err(|error| {
        // A changed input may be the cause of any other error, so it is reported instead.
        opened.inputs.changed_instead_of(error)
    })?;
    if let Err(error) = abandoned {
        observer.warning(&format!("intermediate results were not removed: {error}"));
    }
    Ok(BuildSummary { manifest, package_bytes })
}

fn run(
    context: &Context<'_>,
    store: &LocalStore,
    target: &sums::Target<'_>,
) -> Result<Manifest, BuildError> {
    sums::check_complete(context)?;
    if let GroundSource::Package(terrain) = context.source {
        // Those above the subtrees.
        recorded_tiles::make(context, terrain, TileId::ROOT)?;
    }
    if context.settings.osm.is_some() {
        replay_defects(context.store, context.observer)?;
    }
    coarse_tiles::make(context, TileId::ROOT)?;
    sums::make(context, &store.scratch()?, target)
}
