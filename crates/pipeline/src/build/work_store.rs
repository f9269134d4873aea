//! Where a build keeps its store, and what it does with one that an earlier build left.

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
use corniche_spec::{Leftovers, Observer, artifacts::Kind, hex::hex, inputs::InputError};
use corniche_store::{Artifacts as _, Disk, LocalStore, StoreError, StoredPlan};
use sha2::{Digest as _, Sha256};

use crate::BuildError;

/// Inputs of so many bytes take long to hash: their hashes alone are worth keeping.
const LONG_TO_HASH_BYTES: u64 = 1 << 30;

/// The folder of the store of a build: beside the package, or in `tmp`.
pub(crate) fn folder_of(target: &Path, tmp: Option<&Path>) -> PathBuf {
    let name = target.file_name().unwrap_or_default().to_string_lossy();
    match tmp {
        // Packages of one name in different folders have stores of their own there.
        Some(tmp) => {
            let path = std::path::absolute(target).unwrap_or_else(|_| target.to_path_buf());
            let digest = hex(&Sha256::digest(path.as_os_str().as_encoded_bytes()));
            tmp.join(format!("{name}.{}.work", &digest[..8]))
        }
        None => target.with_file_name(format!(".{name}.work")),
    }
}

/// Fails if a store is there that the build may not use; nothing is changed. Returns the bytes that it takes.
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

/// Fails if the store of an earlier build may not be gone on with.
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

/// Makes the store of a build, or goes on with the one that is there, as `leftovers` says. It lies on a disk, in a folder, and is made
/// durable in an interval.
pub(crate) fn open(
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
    check(folder, plan, &there, leftovers)?;
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
pub(crate) fn remove(store: LocalStore, observer: &dyn Observer) {
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
pub(crate) fn after_failure(
    store: LocalStore,
    folder: &Path,
    plan: &BuildPlan,
    error: &BuildError,
    observer: &dyn Observer,
) {
    let input_bytes = plan.inputs.iter().map(|input| input.bytes).fold(0, u64::saturating_add);
    let has_work = (0..=Kind::LAST as u8)
        .filter(|&kind| kind != Kind::InputHash as u8 || input_bytes >= LONG_TO_HASH_BYTES)
        .any(|kind| !store.items(kind).is_empty());
    if is_final(error) || !has_work {
        remove(store, observer);
        return;
    }
    // What was put since the last time is made durable. If that fails, a little less is there, or nothing any more.
    if matches!(store.flush(), Err(StoreError::Gone { .. })) {
        return;
    }
    observer.warning(&format!(
        "what was done is kept in {}; the same command with --resume goes on from there, with -O it starts again",
        folder.display()
    ));
}

/// Whether the store is of no use any more: it is bound to its inputs and settings, and these must change.
fn is_final(error: &BuildError) -> bool {
    // An input that is gone may come back, with the disk that it lies on.
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
