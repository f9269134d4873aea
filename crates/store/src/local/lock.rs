//! Locks on files, which the kernel releases when a process ends, however it ends. So a lock never
//! outlives its owner, and a file whose lock is free has no owner.

use std::{
    path::{Path, PathBuf},
    process,
    sync::Arc,
};

use crate::{
    Hold, OpenMode, PartFile as _, StoreError,
    files::{Files, OpenFile, is_kind},
    ids::{Marked, marked, random_digits},
    local::layout,
};

/// The number of attempts if another process intervenes. This happens at most once, unless the file
/// system gives wrong answers.
const TRIES: u32 = 100;
/// The beginning of a lock file; random digits and the end of the line follow.
const MARK: &str = "corniche store ";
/// The beginning of the line that names the holder.
const OWNER: &str = "process ";
/// The largest number of bytes of a lock file that are read.
const MOST_BYTES: usize = 300;

/// Takes the lock of the store in `folder`: `Hold::Alone` for a build, `Hold::Shared` for processes
/// that each write their own part.
///
/// # Errors
/// [`StoreError::Locked`] if another process holds it; [`StoreError::Gone`] if its file is deleted
/// again and again.
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
        // The last owner may have deleted the file after this process opened it: then its lock no
        // longer protects anything.
        if file.is_in_place()? {
            sign(&file)?;
            return Ok(file);
        }
    }
    Err(StoreError::Gone { path: folder.to_owned() })
}

/// Creates a file that no other process mistakes for a leftover, because its lock is held. `name`
/// returns a path for each suffix.
pub(crate) fn create_owned(
    files: &Arc<Files>,
    name: impl Fn(&str) -> PathBuf,
) -> Result<OpenFile, StoreError> {
    for _ in 0..TRIES {
        let file = match files.open(&name(&suffix()), OpenMode::New) {
            Err(error) if is_kind(&error, std::io::ErrorKind::AlreadyExists) => continue,
            file => file?,
        };
        // Between the two calls another process may have mistaken the file for a leftover and
        // deleted it.
        if file.try_lock(Hold::Alone)? && file.is_in_place()? {
            return Ok(file);
        }
    }
    Err(StoreError::Gone { path: name("") })
}

/// Opens a file if its owner is dead, and becomes its owner. `None` if its owner is alive, or the
/// file does not exist.
pub(crate) fn adopt(files: &Arc<Files>, path: &Path) -> Result<Option<OpenFile>, StoreError> {
    let Some(file) = files.open_if_there(path, OpenMode::Change)? else { return Ok(None) };
    Ok((file.try_lock(Hold::Alone)? && file.is_in_place()?).then_some(file))
}

/// The content of a file that has the name of a store's lock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Signature {
    /// Nothing, the beginning of Corniche's line, or only the owner (written by older versions): it
    /// can be overwritten without loss.
    None,
    /// It says in this many bytes that this is a store. They are written before anything else of
    /// the store and never change.
    Store(u64),
    /// Something that Corniche did not write.
    Foreign,
}

/// Reads the content of the lock file in a folder; [`Signature::None`] if it does not exist.
pub(crate) fn signature(files: &Arc<Files>, folder: &Path) -> Result<Signature, StoreError> {
    let Some(file) = files.open_if_there(&folder.join(layout::LOCK), OpenMode::Read)? else {
        return Ok(Signature::None);
    };
    match signature_of(&file) {
        // On Windows a locked file cannot be read; its holder has already written into it.
        Err(_) if cfg!(windows) => Ok(Signature::Store(0)),
        signature => signature,
    }
}

fn signature_of(file: &OpenFile) -> Result<Signature, StoreError> {
    let text = read_text(file)?;
    Ok(match marked(&text, MARK) {
        Marked::Id(id, _) => Signature::Store((MARK.len() + id.len() + 1) as u64),
        Marked::Begun => Signature::None,
        Marked::Other if text.starts_with(OWNER) => Signature::None,
        Marked::Other => Signature::Foreign,
    })
}

/// Empties the lock file in a folder if Corniche did not write its content and nobody holds it.
pub(crate) fn clear_foreign(files: &Arc<Files>, folder: &Path) -> Result<(), StoreError> {
    if signature(files, folder)? != Signature::Foreign {
        return Ok(());
    }
    let file = files.open(&folder.join(layout::LOCK), OpenMode::Change)?;
    if !file.try_lock(Hold::Alone)? {
        return Err(StoreError::Locked { path: folder.to_owned(), owner: read_owner(&file) });
    }
    file.set_length(0)
}

/// Writes into a lock file that is held: that this is a store, unless it says so already, and who
/// works here.
///
/// Other holders of a shared lock may read and write the file at the same time. So the mark is
/// never truncated, and the file only becomes shorter after the new text is written.
fn sign(file: &OpenFile) -> Result<(), StoreError> {
    let owner = format!("{OWNER}{} on {}\n", process::id(), host());
    match signature_of(file)? {
        Signature::Store(length) => write_to_end(file, &owner, length)?,
        Signature::None => {
            write_to_end(file, &format!("{MARK}{}\n{owner}", random_digits()), 0)?;
        }
        Signature::Foreign => {
            return Err(StoreError::NotAStore {
                path: file.path().parent().unwrap_or(file.path()).to_owned(),
                what: format!("its {:?} was not written by Corniche", layout::LOCK),
            });
        }
    }
    // The mark must be durable before the files that it protects, even if it was written by a
    // process that died before it could sync.
    file.sync()?;
    file.files().sync_folder(file.path().parent().unwrap_or(file.path()))
}

/// Writes a text that ends the file.
fn write_to_end(file: &OpenFile, text: &str, offset: u64) -> Result<(), StoreError> {
    file.write_all_at(text.as_bytes(), offset)?;
    file.set_length(offset + text.len() as u64)
}

/// Returns the process id with random digits: no two processes, on one machine or on two, choose
/// the same suffix.
pub(crate) fn suffix() -> String {
    format!("{}-{}", process::id(), random_digits())
}

/// Reads the beginning of a lock file, which is short. It can become longer or shorter meanwhile,
/// so its length is not used.
fn read_text(file: &OpenFile) -> Result<String, StoreError> {
    let mut bytes = vec![0; MOST_BYTES];
    let length = file.read_up_to(&mut bytes, 0)?;
    bytes.truncate(length);
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Reads the text that the lock's owner wrote into the file. It is only for users, so it is no
/// error if it cannot be read.
fn read_owner(file: &OpenFile) -> String {
    let text = read_text(file).unwrap_or_default();
    let owner = text.lines().find(|line| line.starts_with(OWNER));
    owner.unwrap_or("another process").to_owned()
}

fn host() -> String {
    let name = std::fs::read_to_string("/proc/sys/kernel/hostname");
    let name = name.ok().or_else(|| std::env::var("HOSTNAME").ok());
    let name = name.or_else(|| std::env::var("COMPUTERNAME").ok()).unwrap_or_default();
    if name.trim().is_empty() { "this machine".to_owned() } else { name.trim().to_owned() }
}

#[cfg(test)]
#[path = "lock_tests.rs"]
mod tests;
