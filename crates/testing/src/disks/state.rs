//! The names and contents of a simulated disk, and which changes are not yet safe on it.

use std::{
    collections::BTreeMap,
    io,
    path::{Path, PathBuf},
};

use corniche_store::Hold;

use super::failure::Failure;

/// Tells open files apart.
pub(crate) type Owner = u64;

/// What a name stands for: a folder, or a file by its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Node {
    Folder,
    File(usize),
}

#[derive(Debug, Clone, Default)]
pub(crate) struct State {
    /// As the code sees them.
    pub(crate) names: BTreeMap<PathBuf, Node>,
    /// As they surely are after a crash.
    pub(crate) durable_names: BTreeMap<PathBuf, Node>,
    /// What leads from the latter to the former.
    pub(crate) changes: Vec<NameChange>,
    /// By number. A file that has no name any more stays.
    pub(crate) files: Vec<Content>,
    pub(crate) calls: u64,
    /// The number of the call that fails, and how.
    pub(crate) planned: Option<(u64, Failure)>,
    pub(crate) is_full: bool,
    /// Syncs of files wait.
    pub(crate) holds_syncs: bool,
    /// How many do.
    pub(crate) held_syncs: u32,
    pub(crate) is_dead: bool,
    pub(crate) owners: Owner,
}

/// A change of names. It happens as a whole or not at all.
#[derive(Debug, Clone)]
pub(crate) enum NameChange {
    Add {
        path: PathBuf,
        node: Node,
    },
    Rename {
        from: PathBuf,
        to: PathBuf,
    },
    Remove {
        path: PathBuf,
    },
    /// A rename of which one folder is synced already.
    HalfSynced {
        from: PathBuf,
        to: PathBuf,
        waits_for: PathBuf,
    },
}

impl NameChange {
    pub(crate) fn names(&self, name: &Path) -> bool {
        match self {
            Self::Add { path, .. } | Self::Remove { path } => path == name,
            Self::Rename { from, to } | Self::HalfSynced { from, to, .. } => {
                from == name || to == name
            }
        }
    }

    /// Does it, if it can be done: an earlier change may be missing.
    pub(crate) fn apply(&self, names: &mut BTreeMap<PathBuf, Node>) {
        match self {
            Self::Add { path, node } => {
                names.insert(path.clone(), *node);
            }
            Self::Remove { path } => {
                names.remove(path);
            }
            Self::Rename { from, to } | Self::HalfSynced { from, to, .. } => {
                if let Some(node) = names.remove(from) {
                    names.insert(to.clone(), node);
                }
            }
        }
    }

    /// What is left of it to be made durable when a folder has been synced.
    fn after_sync(&self, folder: &Path) -> Option<Self> {
        let is_in = |path: &Path| path.parent() == Some(folder);
        match self {
            Self::Add { path, .. } | Self::Remove { path } => (!is_in(path)).then(|| self.clone()),
            Self::Rename { from, to } => match (is_in(from), is_in(to)) {
                (true, true) => None,
                (false, false) => Some(self.clone()),
                (one, _) => {
                    let rest = if one { to } else { from };
                    let waits_for = rest.parent().unwrap_or(Path::new("")).to_owned();
                    Some(Self::HalfSynced { from: from.clone(), to: to.clone(), waits_for })
                }
            },
            Self::HalfSynced { waits_for, .. } => (waits_for != folder).then(|| self.clone()),
        }
    }
}

impl State {
    pub(crate) fn with_folder(folder: &Path) -> Self {
        let names: BTreeMap<_, _> =
            folder.ancestors().map(|path| (path.to_owned(), Node::Folder)).collect();
        Self { durable_names: names.clone(), names, ..Self::default() }
    }

    /// Counts a call. `true` if it is to do half of its work.
    pub(crate) fn count(&mut self, needs_room: bool) -> io::Result<bool> {
        let number = self.calls;
        self.calls += 1;
        let mut is_short = false;
        if let Some((_, failure)) = self.planned.take_if(|(planned, _)| *planned <= number) {
            match failure {
                Failure::Full => self.is_full = true,
                // The number that Linux gives to EIO.
                Failure::Device => return Err(io::Error::from_raw_os_error(5)),
                Failure::Interrupted => return Err(io::ErrorKind::Interrupted.into()),
                Failure::Short => is_short = true,
                Failure::Death => self.is_dead = true,
            }
        }
        if self.is_dead {
            return Err(io::Error::other("the process is dead"));
        }
        if self.is_full && needs_room {
            return Err(io::ErrorKind::StorageFull.into());
        }
        Ok(is_short)
    }

    pub(crate) fn next_owner(&mut self) -> Owner {
        self.owners += 1;
        self.owners
    }

    pub(crate) fn file_at(&self, path: &Path) -> Option<usize> {
        match self.names.get(path) {
            Some(Node::File(number)) => Some(*number),
            _ => None,
        }
    }

    pub(crate) fn add_file(&mut self, path: &Path) -> usize {
        let number = self.files.len();
        self.files.push(Content::default());
        self.change(NameChange::Add { path: path.to_owned(), node: Node::File(number) });
        number
    }

    pub(crate) fn change(&mut self, change: NameChange) {
        change.apply(&mut self.names);
        self.changes.push(change);
    }

    pub(crate) fn check_parent(&self, path: &Path) -> io::Result<()> {
        self.check_folder(path.parent().unwrap_or(Path::new("")))
    }

    pub(crate) fn check_folder(&self, path: &Path) -> io::Result<()> {
        match self.names.get(path) {
            Some(Node::Folder) => Ok(()),
            Some(Node::File(_)) => Err(io::ErrorKind::NotADirectory.into()),
            None => Err(io::ErrorKind::NotFound.into()),
        }
    }

    pub(crate) fn sync_folder(&mut self, folder: &Path) {
        let mut rest = Vec::new();
        for change in self.changes.drain(..) {
            match change.after_sync(folder) {
                Some(change) => rest.push(change),
                None => change.apply(&mut self.durable_names),
            }
        }
        self.changes = rest;
    }

    pub(crate) fn after_kill(&self) -> Self {
        let mut files = self.files.clone();
        for file in &mut files {
            file.locks.clear();
        }
        Self {
            files,
            names: self.names.clone(),
            durable_names: self.durable_names.clone(),
            changes: self.changes.clone(),
            ..Self::default()
        }
    }
}

/// What a file holds.
#[derive(Debug, Clone, Default)]
pub(crate) struct Content {
    /// As the code sees it.
    pub(crate) bytes: Vec<u8>,
    /// As it surely is after a crash, if no change was made after the sync.
    pub(crate) durable: Vec<u8>,
    /// What leads from the latter to the former.
    pub(crate) changes: Vec<ContentChange>,
    locks: Vec<(Owner, Hold)>,
}

#[derive(Debug, Clone)]
pub(crate) enum ContentChange {
    Write { offset: usize, bytes: Vec<u8> },
    Length(usize),
}

impl ContentChange {
    pub(crate) fn apply(&self, content: &mut Vec<u8>) {
        match self {
            Self::Write { offset, bytes } => {
                let end = offset + bytes.len();
                if content.len() < end {
                    content.resize(end, 0);
                }
                content[*offset..end].copy_from_slice(bytes);
            }
            Self::Length(length) => content.resize(*length, 0),
        }
    }
}

impl Content {
    pub(crate) fn of(bytes: Vec<u8>) -> Self {
        Self { durable: bytes.clone(), bytes, ..Self::default() }
    }

    pub(crate) fn set(&mut self, bytes: &[u8]) {
        self.bytes = bytes.to_vec();
        self.durable.clone_from(&self.bytes);
        self.changes.clear();
    }

    pub(crate) fn write(&mut self, offset: usize, bytes: &[u8]) {
        self.change(ContentChange::Write { offset, bytes: bytes.to_vec() });
    }

    pub(crate) fn set_length(&mut self, length: usize) {
        self.change(ContentChange::Length(length));
    }

    fn change(&mut self, change: ContentChange) {
        change.apply(&mut self.bytes);
        self.changes.push(change);
    }

    pub(crate) fn sync(&mut self) {
        for change in self.changes.drain(..) {
            change.apply(&mut self.durable);
        }
    }

    pub(crate) fn try_lock(&mut self, owner: Owner, hold: Hold) -> bool {
        let is_free = (self.locks.iter().filter(|(other, _)| *other != owner))
            .all(|(_, other)| hold == Hold::Shared && *other == Hold::Shared);
        if is_free {
            self.unlock(owner);
            self.locks.push((owner, hold));
        }
        is_free
    }

    pub(crate) fn unlock(&mut self, owner: Owner) {
        self.locks.retain(|(other, _)| *other != owner);
    }
}
