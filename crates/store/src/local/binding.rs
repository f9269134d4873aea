//! Turns a folder into a store: the header that binds it to a plan, and the plan itself.
//!
//! The file `store` is the common header, then the plan's length (8 bytes), its CRC-32 (4) and the
//! CRC-32 of these 12 bytes (4). It gets its name last, when everything else is durable: a folder
//! without this file is not yet a store, even if it has other files of a store.

use std::{path::Path, sync::Arc};

use crate::{
    OpenMode, PlanHash, StoreError, StoredPlan,
    files::Files,
    folder_of,
    local::{
        header::{self, FileKind, HEADER_BYTES, u32_at, u64_at},
        layout,
        lock::{self, Signature},
    },
};

/// The state of a folder.
pub(crate) enum FolderState {
    /// The folder does not exist.
    Absent,
    /// The folder is empty, or has the remains of creating or deleting a store.
    Free,
    /// The folder is a store.
    Store,
}

/// Inspects a folder. The content of its files, never their names, proves that Corniche created it.
///
/// # Errors
/// [`StoreError::NotAStore`] if it contains something that does not belong to a store.
pub(crate) fn state(files: &Arc<Files>, folder: &Path) -> Result<FolderState, StoreError> {
    let Some(found) = layout::look(files, folder)? else {
        return Ok(FolderState::Absent);
    };
    let not_ours = |what: String| Err(StoreError::NotAStore { path: folder.to_owned(), what });
    let has_header = found.has(layout::STORE);
    if !has_header && let Some(name) = found.foreign.first() {
        return not_ours(format!("it contains {name:?}"));
    }
    let signature =
        if found.has(layout::LOCK) { lock::signature(files, folder)? } else { Signature::None };
    let mut unsigned = found.own.iter().map(|(name, _)| name).filter(|&name| name != layout::LOCK);
    match (signature, unsigned.next()) {
        (Signature::Foreign, _) => {
            not_ours(format!("its {:?} was not written by Corniche", layout::LOCK))
        }
        (Signature::None, Some(name)) if !(has_header && is_header(files, folder)?) => {
            not_ours(format!("its {name:?} may not have been created by Corniche"))
        }
        _ if has_header => Ok(FolderState::Store),
        _ => Ok(FolderState::Free),
    }
}

/// Empties a lock file with foreign content if the header proves that the folder is a store, so
/// that the store can be discarded: a lock file contains nothing of value.
pub(crate) fn clear_damaged_lock(files: &Arc<Files>, folder: &Path) -> Result<(), StoreError> {
    let found = layout::look(files, folder)?.unwrap_or_default();
    let is_store = found.has(layout::STORE) && is_header(files, folder)?;
    if is_store && found.has(layout::LOCK) {
        lock::clear_foreign(files, folder)?;
    }
    Ok(())
}

/// Whether the file `store` begins like the header of a store of any version.
fn is_header(files: &Arc<Files>, folder: &Path) -> Result<bool, StoreError> {
    let file = files.open(&folder.join(layout::STORE), OpenMode::Read)?;
    Ok(header::begins_as(FileKind::Store, &file.read_start(HEADER_BYTES)?))
}

/// Returns the content of a store's header, the file `store`.
#[must_use]
pub fn store_header(plan: &StoredPlan) -> Vec<u8> {
    let mut record = header::encode(FileKind::Store, &plan.hash).to_vec();
    record.extend((plan.bytes.len() as u64).to_le_bytes());
    record.extend(crc32fast::hash(&plan.bytes).to_le_bytes());
    let check = crc32fast::hash(&record[HEADER_BYTES as usize..]);
    record.extend(check.to_le_bytes());
    record
}

/// Returns the plan `bytes` with its hash, after checking them against a header, which is the
/// content of the file `store` at `path`.
///
/// # Errors
/// [`StoreError::OtherVersion`]; [`StoreError::Damaged`] if the header is invalid, or header and
/// plan do not belong together.
pub fn plan_of_header(
    header: &[u8],
    bytes: Vec<u8>,
    path: &Path,
) -> Result<StoredPlan, StoreError> {
    let (hash, length, crc) = decode_header(header, path)?;
    if bytes.len() as u64 != length || crc32fast::hash(&bytes) != crc {
        let what = "it is not the plan with which the store was created";
        return Err(FileKind::Store.damaged(&path.with_file_name(layout::PLAN), what));
    }
    Ok(StoredPlan { hash, bytes })
}

/// Makes a folder a store. Two processes may do it at once with the same plan.
pub(crate) fn bind(files: &Arc<Files>, folder: &Path, plan: &StoredPlan) -> Result<(), StoreError> {
    let record = store_header(plan);
    for (name, bytes) in [(layout::PLAN, &plan.bytes), (layout::STORE, &record)] {
        let new = layout::new(folder, name, &lock::suffix());
        let file = files.open(&new, OpenMode::New)?;
        file.write_all_at(bytes, 0)?;
        file.sync()?;
        drop(file);
        files.rename(&new, &folder.join(name))?;
        files.sync_folder(folder)?;
    }
    files.sync_folder(folder_of(folder))
}

/// Reads the hash and checks that it is `plan`.
pub(crate) fn check_hash(
    files: &Arc<Files>,
    folder: &Path,
    plan: &PlanHash,
) -> Result<(), StoreError> {
    let header = read_header(files, folder)?;
    if decode_header(&header, &folder.join(layout::STORE))?.0 == *plan {
        Ok(())
    } else {
        Err(StoreError::OtherPlan { path: folder.to_owned() })
    }
}

/// Reads the plan to which a store is bound.
pub(crate) fn read_plan(files: &Arc<Files>, folder: &Path) -> Result<StoredPlan, StoreError> {
    let header = read_header(files, folder)?;
    let path = folder.join(layout::PLAN);
    let bytes =
        read_whole(files, &path)?.ok_or_else(|| FileKind::Store.damaged(&path, "it is missing"))?;
    plan_of_header(&header, bytes, &folder.join(layout::STORE))
}

/// Reads the header of a folder that must be a store.
fn read_header(files: &Arc<Files>, folder: &Path) -> Result<Vec<u8>, StoreError> {
    read_whole(files, &folder.join(layout::STORE))?
        .ok_or_else(|| StoreError::NoStore { path: folder.to_owned() })
}

/// Decodes the plan's hash, length and CRC-32.
fn decode_header(bytes: &[u8], path: &Path) -> Result<(PlanHash, u64, u32), StoreError> {
    let hash = header::decode(FileKind::Store, bytes, path)?;
    let rest = &bytes[HEADER_BYTES as usize..];
    if rest.len() != 16 || u32_at(rest, 12) != crc32fast::hash(&rest[..12]) {
        return Err(FileKind::Store.damaged(path, "its checksum does not match"));
    }
    Ok((hash, u64_at(rest, 0), u32_at(rest, 8)))
}

/// Reads the content of a file; `None` if it does not exist.
fn read_whole(files: &Arc<Files>, path: &Path) -> Result<Option<Vec<u8>>, StoreError> {
    let file = files.open_if_there(path, OpenMode::Read)?;
    file.map(|file| file.read_start(u64::MAX)).transpose()
}
