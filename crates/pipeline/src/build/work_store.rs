//! The store of a build: where it is, and what happens to the store of an earlier build.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::Arc,
    time::Duration,
};

use corniche_dem::DemError;
use corniche_ground::TerrainError;
use corniche_osm::ReadOsmError;
use corniche_pieces::ExtractError;
use corniche_plan::BuildPlan;
use corniche_spec::{
    BuildObserver, Leftovers, artifacts::ArtifactKind, hex::hex, inputs::InputError,
};
use corniche_store::{Artifacts as _, Disk, LocalStore, StoreError, StoredPlan};
use sha2::{Digest as _, Sha256};

use crate::BuildError;

/// Hashing inputs of this many bytes takes so long that their hashes alone are worth keeping.
const LONG_TO_HASH_BYTES: u64 = 1 << 30;

/// The folder of a build's store: next to the package, or in `tmp`.
pub(crate) fn folder_of(target: &Path, tmp: Option<&Path>) -> PathBuf {
    let name = target.file_name().unwrap_or_default().to_string_lossy();
    match tmp {
        // Packages with the same name in different folders have separate stores there.
        Some(tmp) => {
            let path = std::path::absolute(target).unwrap_or_else(|_| target.to_path_buf());
            let digest = hex(&Sha256::digest(path.as_os_str().as_encoded_bytes()));
            tmp.join(format!("{name}.{}.work", &digest[..8]))
        }
        None => target.with_file_name(format!(".{name}.work")),
    }
}

/// Fails if there is a store that the build may not use; changes nothing. Returns the size of the
/// store in bytes.
pub(crate) fn look(
    disk: &Arc<dyn Disk>,
    folder: &Path,
    plan: &BuildPlan,
    leftovers: Leftovers,
) -> Result<u64, BuildError> {
    if leftovers != Leftovers::Discard
        && let Some(there) = LocalStore::stored_plan(Arc::clone(disk), folder)?
    {
        check(folder, plan, &there, leftovers)?;
    }
    let files = fs::read_dir(folder).into_iter().flatten().flatten();
    Ok(files.filter_map(|file| Some(file.metadata().ok()?.len())).sum())
}

/// Fails if the store of an earlier build may not be resumed.
fn check(
    folder: &Path,
    plan: &BuildPlan,
    there: &StoredPlan,
    leftovers: Leftovers,
) -> Result<(), BuildError> {
    let store = folder.to_path_buf();
    if leftovers == Leftovers::Refuse {
        return Err(BuildError::Leftovers { store });
    }
    if there.hash != plan.digest() {
        return Err(BuildError::OtherBuild { store, differences: differences(plan, there) });
    }
    Ok(())
}

/// Creates the store of a build, or resumes the existing one, depending on `leftovers`. The store
/// is in a folder on a disk, and is synced at an interval.
pub(crate) fn open(
    disk: &Arc<dyn Disk>,
    folder: &Path,
    sync_interval: Duration,
    plan: &BuildPlan,
    leftovers: Leftovers,
    observer: &dyn BuildObserver,
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
                "--resume: {folder:?} contains nothing to resume, so the build starts from the beginning"
            ));
        }
        return Ok(LocalStore::create(Arc::clone(disk), folder, &wanted, sync_interval)?);
    };
    check(folder, plan, &there, leftovers)?;
    let store = LocalStore::open(Arc::clone(disk), folder, &wanted.hash, sync_interval)?;
    if store.repaired() > 0 {
        observer.warning(&format!(
            "{} artifacts in {folder:?} were incomplete; they are computed again",
            store.repaired()
        ));
    }
    Ok(store)
}

/// Converts a plan to its form in a store.
pub(crate) fn stored(plan: &BuildPlan) -> Result<StoredPlan, BuildError> {
    let json = plan.to_json().map_err(|error| BuildError::Start { what: error.to_string() })?;
    Ok(StoredPlan { hash: plan.digest(), bytes: json.into_bytes() })
}

/// Describes how a plan differs from the plan of a store, in words.
pub(crate) fn differences(plan: &BuildPlan, there: &StoredPlan) -> String {
    let earlier =
        std::str::from_utf8(&there.bytes).ok().and_then(|text| BuildPlan::from_json(text).ok());
    match earlier.map(|earlier| plan.differences(&earlier)) {
        Some(differences) if !differences.is_empty() => differences.join("; "),
        _ => "it was created by another version of Corniche".to_owned(),
    }
}

/// Deletes the store of a finished build. Files that cannot be deleted cause only a warning,
/// because the package is complete.
pub(crate) fn remove(store: LocalStore, observer: &dyn BuildObserver) {
    match store.remove() {
        Ok(kept) => {
            for path in kept {
                observer
                    .warning(&format!("{path:?} was not created by Corniche and was not deleted"));
            }
        }
        Err(error) => observer.warning(&format!("intermediate results were not removed: {error}")),
    }
}

/// Handles the store after a failed build: keeps it, with a warning, if a build with `--resume` can
/// continue from it.
pub(crate) fn after_failure(
    store: LocalStore,
    folder: &Path,
    plan: &BuildPlan,
    error: &BuildError,
    observer: &dyn BuildObserver,
) {
    let input_bytes = plan.inputs.iter().map(|input| input.bytes).fold(0, u64::saturating_add);
    let has_work = (0..=ArtifactKind::LAST as u8)
        .filter(|&kind| kind != ArtifactKind::InputHash as u8 || input_bytes >= LONG_TO_HASH_BYTES)
        .any(|kind| !store.items(kind).is_empty());
    if is_final(error) || !has_work {
        remove(store, observer);
        return;
    }
    // Artifacts since the last sync are made durable. If that fails, some or all of them are lost.
    if matches!(store.flush(), Err(StoreError::Gone { .. })) {
        return;
    }
    observer.warning(&format!(
        "progress is saved in {folder:?}; rerun with --resume to continue, or with -O to start over"
    ));
}

/// Whether the store is useless now: it is bound to its inputs and settings, and these must change.
fn is_final(error: &BuildError) -> bool {
    // A missing input may come back, with its disk.
    if let BuildError::Input(InputError::Changed { path }) = error {
        return path.exists();
    }
    let is_bad_extract = |error: &ReadOsmError| !matches!(error, ReadOsmError::Read { .. });
    matches!(error, BuildError::Extract(ExtractError::Osm(error)) if is_bad_extract(error))
        || matches!(
            error,
            BuildError::NoHeights { .. }
                | BuildError::NoCell { .. }
                | BuildError::Extract(
                    ExtractError::NoRoads { .. } | ExtractError::NoOverlap { .. }
                )
                | BuildError::NoGround { .. }
                | BuildError::Terrain(TerrainError::Damaged { .. } | TerrainError::Tile { .. })
                | BuildError::Dem(DemError::Audit(_))
                | BuildError::Triangulate { .. }
                | BuildError::Encode(_)
        )
}
