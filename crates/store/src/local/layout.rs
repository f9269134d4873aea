//! The names in a store's folder. Nothing else is ever made or removed there.

use std::path::{Path, PathBuf};

use crate::{StoreError, files::Files, ids::is_id};

/// Header of the store; with it the folder is a store.
pub const STORE: &str = "store";
/// The plan that the store is bound to, as the caller wrote it.
pub const PLAN: &str = "plan.json";
/// Its lock says who works here.
pub(crate) const LOCK: &str = "lock";
/// Folder of the sealed parts.
pub const PARTS: &str = "parts";

const JOURNAL: &str = ".journal";
const DATA: &str = ".data";
const SCRATCH: &str = ".scratch";
const NEW: &str = ".new";
const SEALED: &str = ".part";

/// What a name in a store's folder stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// Header, plan or lock.
    Fixed,
    /// The journal of an open part.
    Journal,
    /// The artifacts of an open part.
    Data,
    /// Scratch space.
    Scratch,
    /// A file that was to be renamed.
    New,
    /// The folder of sealed parts.
    Parts,
}

pub(crate) fn journal(folder: &Path, part: &str, suffix: &str) -> PathBuf {
    folder.join(format!("{part}.{suffix}{JOURNAL}"))
}

/// The artifacts of an open part, from its journal's path.
pub(crate) fn data_of_journal(journal: &Path) -> PathBuf {
    journal.with_extension(&DATA[1..])
}

/// The journal of an open part, from the path of its artifacts.
pub(crate) fn journal_of_data(data: &Path) -> PathBuf {
    data.with_extension(&JOURNAL[1..])
}

pub(crate) fn scratch(folder: &Path, suffix: &str) -> PathBuf {
    folder.join(format!("{suffix}{SCRATCH}"))
}

/// A file that gets the name `name` when it is whole.
pub(crate) fn new(folder: &Path, name: &str, suffix: &str) -> PathBuf {
    folder.join(format!("{name}.{suffix}{NEW}"))
}

pub(crate) fn sealed(folder: &Path, part: &str, digest: &str) -> PathBuf {
    folder.join(PARTS).join(format!("{part}.{digest}{SEALED}"))
}

/// Which part a file name is that of (`NAME.DIGEST.part`); `None` if it is no name of a sealed part.
#[must_use]
pub fn part_of_sealed(file_name: &str) -> Option<&str> {
    file_name.strip_suffix(SEALED)?.rsplit_once('.').map(|(part, _)| part)
}

/// The digest in the name of a sealed part.
pub(crate) fn digest_of_sealed(name: &str) -> Option<&str> {
    name.strip_suffix(SEALED)?.rsplit_once('.').map(|(_, digest)| digest)
}

/// Which open part a journal belongs to.
pub(crate) fn part_of_journal(name: &str) -> Option<&str> {
    name.strip_suffix(JOURNAL)?.rsplit_once('.').map(|(part, _)| part)
}

/// A part's name goes into file names, between dots.
pub(crate) fn check_part_name(name: &str) -> Result<(), StoreError> {
    let fine = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    if !name.is_empty() && name.len() <= 100 && name.chars().all(fine) {
        Ok(())
    } else {
        Err(StoreError::PartName { name: name.to_owned() })
    }
}

/// What the store's own files in a folder are, and the first thing there that is none of the store's.
#[derive(Debug, Default)]
pub(crate) struct Found {
    pub(crate) own: Vec<(String, Role)>,
    pub(crate) foreign: Vec<String>,
}

impl Found {
    pub(crate) fn has(&self, name: &str) -> bool {
        self.own.iter().any(|(own, _)| own == name)
    }

    /// The names of one role.
    pub(crate) fn of(&self, role: Role) -> impl Iterator<Item = &str> {
        self.own.iter().filter(move |(_, own)| *own == role).map(|(name, _)| name.as_str())
    }
}

/// Looks into a folder; `None` if it is not there.
pub(crate) fn look(files: &Files, folder: &Path) -> Result<Option<Found>, StoreError> {
    let Some(listed) = files.list(folder)? else { return Ok(None) };
    let mut found = Found::default();
    for entry in listed {
        let name = entry.name.to_string_lossy().into_owned();
        match role(&name, entry.is_folder) {
            // Only ASCII has a role, so nothing was lost.
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
    // The others have process id and random digits before their ending: `-` between the last two dots.
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
