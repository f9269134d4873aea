//! The names of files in a store's folder. Nothing else is ever created or deleted there.

use std::path::{Path, PathBuf};

use crate::{StoreError, files::Files, ids::is_id};

/// The header of the store; a folder with this file is a store.
pub const STORE: &str = "store";
/// The plan that the store is bound to, as the caller wrote it.
pub const PLAN: &str = "plan.json";
/// The lock file, which names the process that works here.
pub(crate) const LOCK: &str = "lock";
/// The folder of the sealed parts.
pub const PARTS: &str = "parts";

const JOURNAL: &str = ".journal";
const DATA: &str = ".data";
const SCRATCH: &str = ".scratch";
const NEW: &str = ".new";
const SEALED: &str = ".part";

/// The role of a name in a store's folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// The header, the plan or the lock.
    Fixed,
    /// The journal of an open part.
    Journal,
    /// The artifacts of an open part.
    Data,
    /// Scratch space.
    Scratch,
    /// A file that was to be renamed after it was complete.
    New,
    /// The folder of sealed parts.
    Parts,
}

pub(crate) fn journal(folder: &Path, part: &str, suffix: &str) -> PathBuf {
    folder.join(format!("{part}.{suffix}{JOURNAL}"))
}

/// Returns the path of the artifacts of an open part, from its journal's path.
pub(crate) fn data_of_journal(journal: &Path) -> PathBuf {
    journal.with_extension(&DATA[1..])
}

/// Returns the path of the journal of an open part, from the path of its artifacts.
pub(crate) fn journal_of_data(data: &Path) -> PathBuf {
    data.with_extension(&JOURNAL[1..])
}

pub(crate) fn scratch(folder: &Path, suffix: &str) -> PathBuf {
    folder.join(format!("{suffix}{SCRATCH}"))
}

/// Returns the path of a file that gets the name `name` when it is complete.
pub(crate) fn new(folder: &Path, name: &str, suffix: &str) -> PathBuf {
    folder.join(format!("{name}.{suffix}{NEW}"))
}

pub(crate) fn sealed(folder: &Path, part: &str, digest: &str) -> PathBuf {
    folder.join(PARTS).join(format!("{part}.{digest}{SEALED}"))
}

/// Returns the name of the part in a file name `NAME.DIGEST.part`; `None` if it is not the name of
/// a sealed part.
#[must_use]
pub fn part_of_sealed(file_name: &str) -> Option<&str> {
    file_name.strip_suffix(SEALED)?.rsplit_once('.').map(|(part, _)| part)
}

/// Returns the digest in the name of a sealed part.
pub(crate) fn digest_of_sealed(name: &str) -> Option<&str> {
    name.strip_suffix(SEALED)?.rsplit_once('.').map(|(_, digest)| digest)
}

/// Returns the name of the open part to which a journal belongs.
pub(crate) fn part_of_journal(name: &str) -> Option<&str> {
    name.strip_suffix(JOURNAL)?.rsplit_once('.').map(|(part, _)| part)
}

/// Checks the name of a part, which becomes a component of file names, between dots.
pub(crate) fn check_part_name(name: &str) -> Result<(), StoreError> {
    let fine = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    if !name.is_empty() && name.len() <= 100 && name.chars().all(fine) {
        Ok(())
    } else {
        Err(StoreError::PartName { name: name.to_owned() })
    }
}

/// The store's own files in a folder with their roles, and the first entry that does not belong to
/// a store.
#[derive(Debug, Default)]
pub(crate) struct StoreFolderFiles {
    pub own: Vec<(String, Role)>,
    pub foreign: Vec<String>,
}

impl StoreFolderFiles {
    pub(crate) fn has(&self, name: &str) -> bool {
        self.own.iter().any(|(own, _)| own == name)
    }

    /// Iterates over the names with a role.
    pub(crate) fn files_with_role(&self, role: Role) -> impl Iterator<Item = &str> {
        self.own.iter().filter(move |(_, own)| *own == role).map(|(name, _)| name.as_str())
    }
}

/// Lists a folder; `None` if it does not exist.
pub(crate) fn look(files: &Files, folder: &Path) -> Result<Option<StoreFolderFiles>, StoreError> {
    let Some(listed) = files.list(folder)? else { return Ok(None) };
    let mut found = StoreFolderFiles::default();
    for entry in listed {
        let name = entry.name.to_string_lossy().into_owned();
        match role(&name, entry.is_folder) {
            // Only ASCII names have a role, so the conversion lost nothing.
            Some(role) => found.own.push((name, role)),
            None => found.foreign.push(name),
        }
    }
    Ok(Some(found))
}

fn role(name: &str, is_folder: bool) -> Option<Role> {
    if is_folder {
        return (name == PARTS).then_some(Role::Parts);
    }
    // The other names have process id and random digits before their ending: `-` between the last
    // two dots.
    let has_suffix = |stem: &str| {
        let suffix = stem.rsplit('.').next().unwrap_or_default();
        suffix.split_once('-').is_some_and(|(process, digits)| {
            process.bytes().all(|c| c.is_ascii_digit()) && is_id(digits)
        })
    };
    let endings =
        [(JOURNAL, Role::Journal), (DATA, Role::Data), (SCRATCH, Role::Scratch), (NEW, Role::New)];
    if [STORE, PLAN, LOCK].contains(&name) {
        return Some(Role::Fixed);
    }
    let (stem, role) =
        endings.iter().find_map(|(end, role)| Some((name.strip_suffix(end)?, *role)))?;
    has_suffix(stem).then_some(role)
}
