//! Who uses what: locks that the kernel gives back when a process ends, however it ends. So a lock never outlives its owner, and a file
//! whose lock is free has no owner.

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

/// How often one tries again where another process came in between. That happens once at most, unless the file system gives wrong answers.
const TRIES: u32 = 100;
/// What a lock begins with; random digits follow, and the end of the line.
const MARK: &str = "corniche store ";
/// What the line begins with that says who holds it.
const OWNER: &str = "process ";
/// So much of a lock is read at most.
const MOST_BYTES: usize = 300;

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
            sign(&file)?;
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
    let Some(file) = files.open_if_there(path, OpenMode::Change)? else { return Ok(None) };
    Ok((file.try_lock(Hold::Alone)? && file.is_in_place()?).then_some(file))
}

/// What a file says that has the name of a store's lock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Signature {
    /// Nothing, the beginning of our line, or the owner alone, as older versions had it: nothing is lost when it is written.
    None,
    /// It says that a store is here, in so many bytes, which are written before anything else of the store and never changed.
    Store(u64),
    /// Something that is not ours.
    Foreign,
}

/// What the lock in a folder says; [`Signature::None`] where it is not there.
pub(crate) fn signature(files: &Arc<Files>, folder: &Path) -> Result<Signature, StoreError> {
    let Some(file) = files.open_if_there(&folder.join(layout::LOCK), OpenMode::Read)? else {
        return Ok(Signature::None);
    };
    match signature_of(&file) {
        // Windows lets nobody read what is locked; who holds it has written into it before.
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

/// Empties the lock in a folder if what it says is not ours and nobody holds it.
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

/// Writes into a lock that is held: that a store is here, unless it says so, and who works here.
///
/// Others that share it may read and sign it meanwhile. So the mark is never cut off, and the file gets shorter only once the new text is there.
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
    // Durable before what it speaks for, also where it was signed by a process that died before it could see to that.
    file.sync()?;
    file.files().sync_folder(file.path().parent().unwrap_or(file.path()))
}

/// Writes a text that ends the file.
fn write_to_end(file: &OpenFile, text: &str, offset: u64) -> Result<(), StoreError> {
    file.write_all_at(text.as_bytes(), offset)?;
    file.set_length(offset + text.len() as u64)
}

/// Process id and random digits: two processes, of one machine or of two, never choose the same.
pub(crate) fn suffix() -> String {
    format!("{}-{}", process::id(), random_digits())
}

/// The beginning of a lock, which is short. It can get longer or shorter meanwhile, so its length is not asked.
fn read_text(file: &OpenFile) -> Result<String, StoreError> {
    let mut bytes = vec![0; MOST_BYTES];
    let length = file.read_up_to(&mut bytes, 0)?;
    bytes.truncate(length);
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// What the lock's owner wrote into it. It is for people only, so that not being able to read it is no error.
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
