//! Runs one step for one subtree or share.

use std::path::PathBuf;

use corniche_geom::TileId;
use corniche_objects::StorageRequests;
use corniche_osm::Share;
use corniche_plan::BuildPlan;
use corniche_spec::{BuildObserver, Resources, inputs::InputError};
use corniche_store::LocalStore;

use super::{
    needed_parts::{is_needed, part_name},
    planned::open,
    step::PartStep,
    stores::Stores,
};
use crate::{
    BuildError,
    build::warn,
    context::BuildContext,
    objects::ObjectAccess,
    steps::{hashes, heights, roads, shares, tiles, top},
};

/// The settings of a part.
#[derive(Debug, Clone)]
pub struct PartSettings {
    /// The plan of the build.
    pub plan: BuildPlan,
    /// Folders of parts, or addresses in object storage (`s3://BUCKET/PREFIX`): all are read, and
    /// the first is written, and created if it does not exist.
    pub stores: Vec<PathBuf>,
    /// The folder for a part that is then uploaded to object storage; `None`: the system's
    /// temporary folder.
    pub tmp: Option<PathBuf>,
    /// The step to run.
    pub step: PartStep,
    /// The subtree, for [steps with subtrees](PartStep::has_subtrees); `None` means all tiles.
    pub subtree: Option<TileId>,
    /// The share of the extract, for [steps with shares](PartStep::has_shares); `None` means all of
    /// it.
    pub share: Option<Share>,
    /// The resources that the run may use.
    pub resources: Resources,
    /// Program and version. It must be the program that created the plan.
    pub generator: String,
}

/// The result of building a part.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PartSummary {
    /// The part's file or address; `None` if the stores already had all of it.
    pub sealed: Option<PathBuf>,
    /// Requests to object storage; `None` if no store is there.
    pub requests: Option<StorageRequests>,
}

/// Builds a part of a build and writes it to the first store, as one file that is never changed
/// again. If the run ends early, its progress is saved next to the part, and a rerun continues from
/// there.
///
/// # Errors
/// See [`BuildError`]; [`BuildError::Artifact`] if an earlier step is not in the stores.
pub fn make_part(
    settings: &PartSettings,
    observer: &dyn BuildObserver,
) -> Result<PartSummary, BuildError> {
    let PartSettings { plan, stores, tmp, step, subtree, share, resources, generator } = settings;
    if let (Some(subtree), false) = (subtree, step.has_subtrees()) {
        let why = format!("the step {} covers all tiles at once; omit --subtree", step.name());
        return Err(BuildError::Subtree { subtree: *subtree, why });
    }
    if let (Some(share), false) = (share, step.has_shares()) {
        let why = format!("the step {} has no chunks; omit --share", step.name());
        return Err(BuildError::Share { share: *share, why });
    }
    let scope = subtree.unwrap_or(TileId::ROOT);
    let share = share.unwrap_or(Share::WHOLE);
    let stores = Stores::look(stores, tmp.as_deref(), plan, ObjectAccess::new(*resources), true)?;
    let (plan_settings, opened) = open(plan, generator, *resources)?;
    let finest_level = opened.grid.frame.max_level();
    if scope.z() > finest_level {
        let why = format!("the finest level is {finest_level}");
        return Err(BuildError::Subtree { subtree: scope, why });
    }
    let name = part_name(*step, scope, share);
    let open = stores.open(&name, &|part| is_needed(*step, scope, share, part))?;
    let store = &open.store;
    let context = BuildContext::new(&plan_settings, *resources, &opened, store, observer);
    let made = make(&context, *step, (scope, share), store);
    // The plan has the state of the inputs at the start. If they have changed since, nothing of the
    // part may be used.
    match opened.inputs.check_unchanged() {
        Err(changed @ InputError::Changed { .. }) => {
            open.abandon()?;
            return Err(changed.into());
        }
        // An input whose state cannot be read does not invalidate the part.
        unchanged => {
            if let Err(error) = made.and(unchanged.map_err(BuildError::from)) {
                open.leave(observer);
                return Err(error);
            }
        }
    }
    let sealed = open.keep(observer)?;
    Ok(PartSummary { sealed, requests: stores.requests() })
}

fn make(
    context: &BuildContext<'_>,
    step: PartStep,
    (scope, share): (TileId, Share),
    store: &LocalStore,
) -> Result<(), BuildError> {
    match step {
        PartStep::Hashes => hashes::make(context),
        PartStep::Ways => shares::make_ways(context, share, &store.scratch()?),
        PartStep::Nodes => shares::make_nodes(context, share, &store.scratch()?),
        PartStep::Roads => roads::make(context, &store.scratch()?),
        PartStep::Heights | PartStep::Tiles if context.data().within(scope).is_empty() => Ok(()),
        PartStep::Heights => heights::make(context, scope),
        PartStep::Top => {
            warn(context);
            top::make(context)
        }
        PartStep::Tiles => tiles::make(context, scope),
    }
}
