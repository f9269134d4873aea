//! The names and contents of a simulated disk, and the changes that are not durable yet.

use std::{
    collections::BTreeMap,
    io,
    path::{Path, PathBuf},
};

use corniche_store::Hold;

use super::failure::DiskFailure;

/// Distinguishes open files.
pub(crate) type FileOwner = u64;

/// The target of a name: a folder, or a file by its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum DiskNode {
    Folder,
    File(usize),
}

#[derive(Debug, Clone, Default)]
pub(crate) struct State {
    /// The names as the code sees them.
    pub(crate) names: BTreeMap<PathBuf, DiskNode>,
    /// The names that certainly exist after a crash.
    pub(crate) durable_names: BTreeMap<PathBuf, DiskNode>,
    /// The changes that lead from the durable names to the current ones.
    pub(crate) changes: Vec<NameChange>,
    /// The files by number. A file without a name remains.
    pub(crate) files: Vec<DiskContent>,
    pub(crate) calls: u64,
    /// The number of the call that fails, and its failure.
    pub(crate) planned: Option<(u64, DiskFailure)>,
    pub(crate) is_full: bool,
    /// Whether syncs of files wait.
    pub(crate) holds_syncs: bool,
    /// The number of waiting syncs.
    pub(crate) held_syncs: u32,
    pub(crate) is_dead: bool,
    pub(crate) owners: FileOwner,
}

/// A change of names. It happens as a whole or not at all.
#[derive(Debug, Clone)]
pub(crate) enum NameChange {
    Add {
        path: PathBuf,
        node: DiskNode,
    },
    Rename {
        from: PathBuf,
        to: PathBuf,
    },
    Remove {
        path: PathBuf,
    },
    /// A rename of which one folder is already synced.
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

    /// Applies the change if possible: an earlier change may be missing.
    pub(crate) fn apply(&self, names: &mut BTreeMap<PathBuf, DiskNode>) {
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

    /// Returns the part of the change that still has to become durable after a folder was synced.
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
            folder.ancestors().map(|path| (path.to_owned(), DiskNode::Folder)).collect();
        Self { durable_names: names.clone(), names, ..Self::default() }
    }

    /// Counts a call. Returns `true` if the call should do half of its work.
    pub(crate) fn count(&mut self, needs_room: bool) -> io::Result<bool> {
        let number = self.calls;
        self.calls += 1;
        let mut is_short = false;
        if let Some((_, failure)) = self.planned.take_if(|(planned, _)| *planned <= number) {
            match failure {
                DiskFailure::Full => self.is_full = true,
                // This is Linux's number of EIO.
                DiskFailure::Device => return Err(io::Error::from_raw_os_error(5)),
                DiskFailure::Interrupted => return Err(io::ErrorKind::Interrupted.into()),
                DiskFailure::Short => is_short = true,
                DiskFailure::Death => self.is_dead = true,
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

    pub(crate) fn next_owner(&mut self) -> FileOwner {
        self.owners += 1;
        self.owners
    }

    pub(crate) fn file_at(&self, path: &Path) -> Option<usize> {
        match self.names.get(path) {
            Some(DiskNode::File(number)) => Some(*number),
            _ => None,
        }
    }

    pub(crate) fn add_file(&mut self, path: &Path) -> usize {
        let number = self.files.len();
        self.files.push(DiskContent::default());
        self.change(NameChange::Add { path: path.to_owned(), node: DiskNode::File(number) });
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
            Some(DiskNode::Folder) => Ok(()),
            Some(DiskNode::File(_)) => Err(io::ErrorKind::NotADirectory.into()),
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

/// The content of a file.
#[derive(Debug, Clone, Default)]
pub(crate) struct DiskContent {
    /// The content as the code sees it.
    pub(crate) bytes: Vec<u8>,
    /// The content that certainly exists after a crash, if no change was made after the sync.
    pub(crate) durable: Vec<u8>,
    /// The changes that lead from the durable content to the current one.
    pub(crate) changes: Vec<ContentChange>,
    locks: Vec<(FileOwner, Hold)>,
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

impl DiskContent {
    pub(crate) fn from_bytes(bytes: Vec<u8>) -> Self {
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

    pub(crate) fn try_lock(&mut self, owner: FileOwner, hold: Hold) -> bool {
        let is_free = (self.locks.iter().filter(|(other, _)| *other != owner))
            .all(|(_, other)| hold == Hold::Shared && *other == Hold::Shared);
        if is_free {
            self.unlock(owner);
            self.locks.push((owner, hold));
        }
        is_free
    }

    pub(crate) fn unlock(&mut self, owner: FileOwner) {
        self.locks.retain(|(other, _)| *other != owner);
    }
}
