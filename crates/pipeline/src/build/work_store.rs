//! Where a build keeps its store, and what it does with one that an earlier build left.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
    time::Duration,
};

use corniche_dem::DemError;
use corniche_store::{Artifacts as _, Disk, LocalStore, StoredPlan};

use crate::{BuildError, BuildPlan, Leftovers, Observer, artifacts::Kind};

/// The folder of the store of a build: beside the package, or in `tmp`.
pub(super) fn folder_of(target: &Path, tmp: Option<&Path>) -> PathBuf {
    let name = target.file_name().unwrap_or_default().to_string_lossy();
    match tmp {
        Some(tmp) => tmp.join(format!("{name}.work")),
        None => target.with_file_name(format!(".{name}.work")),
    }
}

/// Makes the store of a build, or goes on with the one that is there, as `leftovers` says. It lies on a disk, in a folder, and is made
/// durable in an interval.
pub(super) fn open(
    (disk, folder, sync_interval): (&Arc<dyn Disk>, &Path, Duration),
    plan: &BuildPlan,
    leftovers: Leftovers,
    observer: &dyn Observer,
) -> Result<LocalStore, BuildError> {
    if leftovers == Leftovers::Discard {
        let kept = LocalStore::discard(Arc::clone(disk), folder)?;
        if let Some(kept) = kept.into_iter().next() {
            return Err(BuildError::NotOurs { folder: folder.to_path_buf(), kept });
        }
    }
    let wanted = stored(plan)?;
    let Some(there) = LocalStore::stored_plan(Arc::clone(disk), folder)? else {
        if leftovers == Leftovers::Resume {
            observer.warning(&format!(
                "--resume: {} holds nothing to go on from, so the build starts from the beginning",
                folder.display()
            ));
        }
        return Ok(LocalStore::create(Arc::clone(disk), folder, &wanted, sync_interval)?);
    };
    if leftovers == Leftovers::Refuse {
        return Err(BuildError::Leftovers { store: folder.to_path_buf() });
    }
    if there.hash != wanted.hash {
        return Err(BuildError::OtherBuild {
            store: folder.to_path_buf(),
            differences: differences(plan, &there),
        });
    }
    let store = LocalStore::open(Arc::clone(disk), folder, &wanted.hash, sync_interval)?;
    if store.repaired() > 0 {
        observer.warning(&format!(
            "{} artifacts in {} were not complete; they are made again",
            store.repaired(),
            folder.display()
        ));
    }
    Ok(store)
}

/// A plan as a store keeps it.
pub(crate) fn stored(plan: &BuildPlan) -> Result<StoredPlan, BuildError> {
    let json = plan.to_json().map_err(|error| BuildError::Start { what: error.to_string() })?;
    Ok(StoredPlan { hash: plan.digest(), bytes: json.into_bytes() })
}

/// How a plan differs from the one of a store, in words.
pub(crate) fn differences(plan: &BuildPlan, there: &StoredPlan) -> String {
    let earlier =
        std::str::from_utf8(&there.bytes).ok().and_then(|text| BuildPlan::from_json(text).ok());
    match earlier.map(|earlier| plan.differences(&earlier)) {
        Some(differences) if !differences.is_empty() => differences.join("; "),
        _ => "it was made by another version of Corniche".to_owned(),
    }
}

/// Removes the store of a build that is done. What cannot be removed is only told of: the package is complete.
pub(super) fn remove(store: LocalStore, observer: &dyn Observer) {
    match store.remove() {
        Ok(kept) => {
            for path in kept {
                observer.warning(&format!("{} is not Corniche's and was kept", path.display()));
            }
        }
        Err(error) => observer.warning(&format!("intermediate results were not removed: {error}")),
    }
}

/// What a failed build leaves: the store, if a build with `--resume` can go on from it. Tells so.
pub(super) fn after_failure(
    store: LocalStore,
    folder: &Path,
    error: &BuildError,
    observer: &dyn Observer,
) {
    // Hashes of inputs are made in no time.
    let kinds = Kind::ALL.iter().filter(|&&kind| kind != Kind::InputHash);
    let has_work = kinds.clone().any(|&kind| !store.items(kind as u8).is_empty());
    if is_final(error) || !has_work {
        remove(store, observer);
        return;
    }
    // What was put since the last time is made durable. If that fails, a little less is there.
    let _ = store.flush();
    observer.warning(&format!(
        "what was done is kept in {}; the same command with --resume goes on from there, with -O it starts again",
        folder.display()
    ));
}

/// Whether the same build must fail again: a store is bound to its inputs and settings, and these must change.
fn is_final(error: &BuildError) -> bool {
    matches!(
        error,
        BuildError::NoHeights { .. }
            | BuildError::NoCell { .. }
            | BuildError::NoRoads { .. }
            | BuildError::NoOverlap { .. }
            | BuildError::NoGround { .. }
            | BuildError::Changed { .. }
            | BuildError::Exists { .. }
            | BuildError::Osm(_)
            | BuildError::Dem(DemError::OutOfRange { .. } | DemError::Sentinel { .. })
            | BuildError::Triangulate { .. }
    )
}
