//! Who uses what: locks that the kernel gives back when a process ends, however it ends. So a lock never outlives its owner, and a file
//! whose lock is free has no owner.

use std::{
    hash::{BuildHasher, Hasher, RandomState},
    path::{Path, PathBuf},
    process,
    sync::Arc,
};

use crate::{
    Hold, OpenMode, StoreError,
    files::{Files, OpenFile, is_kind},
    local::layout,
};

/// How often one tries again where another process came in between. That happens once at most, unless the file system gives wrong answers.
const TRIES: u32 = 100;

/// Takes the lock of the store in `folder`. `Hold::Alone` for a build, `Hold::Shared` for those that each make a part of their own.
///
/// # Errors
/// [`StoreError::Locked`] if another process has it; [`StoreError::Gone`] if its file is removed again and again.
pub(crate) fn lock_store(
    files: &Arc<Files>,
    folder: &Path,
    hold: Hold,
) -> Result<OpenFile, StoreError> {
    for _ in 0..TRIES {
        let file = files.open(&folder.join(layout::LOCK), OpenMode::ChangeOrNew)?;
        if !file.try_lock(hold)? {
            let owner = read_owner(&file);
            return Err(StoreError::Locked { path: folder.to_owned(), owner });
        }
        // The last owner may have removed the file after we opened it: then it guards nothing any more.
        if file.is_in_place()? {
            let owner = format!("process {} on {}\n", process::id(), host());
            file.set_length(0)?;
            file.write_all_at(owner.as_bytes(), 0)?;
            return Ok(file);
        }
    }
    Err(StoreError::Gone { path: folder.to_owned() })
}

/// Creates a file that no other process takes for a leftover: its lock is held. `name` gives a path for each suffix.
pub(crate) fn create_owned(
    files: &Arc<Files>,
    name: impl Fn(&str) -> PathBuf,
) -> Result<OpenFile, StoreError> {
    for _ in 0..TRIES {
        let file = match files.open(&name(&suffix()), OpenMode::New) {
            Err(error) if is_kind(&error, std::io::ErrorKind::AlreadyExists) => continue,
            file => file?,
        };
        // Between the two calls another process may have taken it for a leftover and removed it.
        if file.try_lock(Hold::Alone)? && file.is_in_place()? {
            return Ok(file);
        }
    }
    Err(StoreError::Gone { path: name("") })
}

/// Opens a file if its owner is dead, and becomes its owner. `None` if its owner lives, or the file is gone.
pub(crate) fn adopt(files: &Arc<Files>, path: &Path) -> Result<Option<OpenFile>, StoreError> {
    let file = match files.open(path, OpenMode::Change) {
        Err(error) if is_kind(&error, std::io::ErrorKind::NotFound) => return Ok(None),
        file => file?,
    };
    Ok((file.try_lock(Hold::Alone)? && file.is_in_place()?).then_some(file))
}

/// Process id and random digits: two processes, of one machine or of two, never choose the same.
pub(crate) fn suffix() -> String {
    // Each `RandomState` has new keys from the system.
    let digits = RandomState::new().build_hasher().finish();
    format!("{}-{digits:016x}", process::id())
}

/// What the lock's owner wrote into it. It is for people only, so that not being able to read it is no error.
fn read_owner(file: &OpenFile) -> String {
    let mut bytes = vec![0; file.length().unwrap_or(0).min(200) as usize];
    let read = file.read_exact_at(&mut bytes, 0);
    let owner = String::from_utf8_lossy(&bytes).trim().to_owned();
    if read.is_err() || owner.is_empty() { "another process".to_owned() } else { owner }
}

fn host() -> String {
    let name = std::fs::read_to_string("/proc/sys/kernel/hostname");
    let name = name.ok().or_else(|| std::env::var("HOSTNAME").ok());
    let name = name.or_else(|| std::env::var("COMPUTERNAME").ok()).unwrap_or_default();
    if name.trim().is_empty() { "this machine".to_owned() } else { name.trim().to_owned() }
}
