//! One step for one subtree.

use std::path::PathBuf;

use corniche_geom::TileId;
use corniche_objects::Requests;
use corniche_osm::Share;
use corniche_plan::BuildPlan;
use corniche_spec::{Observer, Resources, inputs::InputError};
use corniche_store::LocalStore;

use super::{
    needed_parts::{is_needed, part_name},
    planned::open,
    step::Step,
    stores::{GivenStores, Stores},
};
use crate::{
    BuildError,
    build::warn,
    context::Context,
    objects::ObjectAccess,
    steps::{hashes, heights, roads, shares, tiles, top},
};

/// Which part of a build to make.
#[derive(Debug, Clone)]
pub struct PartSettings {
    /// What is built.
    pub plan: BuildPlan,
    /// Folders of parts, or addresses in object storage (`s3://BUCKET/PREFIX`): all are read, and the first is written and made if it is not there.
    pub stores: Vec<PathBuf>,
    /// Where a part is made that then goes to object storage; `None`: the system's folder for temporary files.
    pub tmp: Option<PathBuf>,
    /// The step to do.
    pub step: Step,
    /// The subtree, for [steps with subtrees](Step::has_subtrees); `None` means all tiles.
    pub subtree: Option<TileId>,
    /// The share of the extract, for [steps with shares](Step::has_shares); `None` means all of it.
    pub share: Option<Share>,
    /// What the run may use.
    pub resources: Resources,
    /// Program and version. It must be the one that made the plan.
    pub generator: String,
}

/// What came of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PartSummary {
    /// The part's file or address; `None` if all of it was in the stores already.
    pub sealed: Option<PathBuf>,
    /// What was asked of object storage; `None` if no store is there.
    pub requests: Option<Requests>,
}

/// Makes a part of a build and keeps it in the first store, as one file that is never changed again. If the run ends early, what was
/// done is kept beside it, and the same part goes on from there.
///
/// # Errors
/// See [`BuildError`]; [`BuildError::Artifact`] if an earlier step is not in the stores.
pub fn make_part(
    settings: &PartSettings,
    observer: &dyn Observer,
) -> Result<PartSummary, BuildError> {
    let PartSettings { plan, stores, tmp, step, subtree, share, resources, generator } = settings;
    if let (Some(subtree), false) = (subtree, step.has_subtrees()) {
        let why = format!("the step {} is done for all tiles at once; leave it out", step.name());
        return Err(BuildError::Subtree { subtree: *subtree, why });
    }
    if let (Some(share), false) = (share, step.has_shares()) {
        let why = format!("the step {} has no shares; leave it out", step.name());
        return Err(BuildError::Share { share: *share, why });
    }
    let scope = subtree.unwrap_or(TileId::ROOT);
    let share = share.unwrap_or(Share::WHOLE);
    let given = GivenStores { names: stores, tmp: tmp.as_deref() };
    let stores = Stores::look(given, plan, ObjectAccess::new(*resources), true)?;
    let (plan_settings, opened) = open(plan, generator, *resources)?;
    let finest_level = opened.grid.frame.max_level();
    if scope.z() > finest_level {
        let why = format!("the finest level is {finest_level}");
        return Err(BuildError::Subtree { subtree: scope, why });
    }
    let name = part_name(*step, scope, share);
    let open = stores.open(&name, &|part| is_needed(*step, scope, share, part))?;
    let store = &open.store;
    let context = Context::new(&plan_settings, *resources, &opened, store, observer);
    let made = make(&context, *step, (scope, share), store);
    // The plan says what the inputs were at the start. If they have changed since, nothing of the part may be used.
    match opened.inputs.check_unchanged() {
        Err(changed @ InputError::Changed { .. }) => {
            open.abandon()?;
            return Err(changed.into());
        }
        // One that cannot be looked at says nothing about what was made.
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
    context: &Context<'_>,
    step: Step,
    (scope, share): (TileId, Share),
    store: &LocalStore,
) -> Result<(), BuildError> {
    match step {
        Step::Hashes => hashes::make(context),
        Step::Ways => shares::make_ways(context, share, &store.scratch()?),
        Step::Nodes => shares::make_nodes(context, share, &store.scratch()?),
        Step::Roads => roads::make(context, &store.scratch()?),
        Step::Heights | Step::Tiles if context.data().within(scope).is_empty() => Ok(()),
        Step::Heights => heights::make(context, scope),
        Step::Top => {
            warn(context);
            top::make(context)
        }
        Step::Tiles => tiles::make(context, scope),
    }
}
