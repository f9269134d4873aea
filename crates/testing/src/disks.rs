//! A disk in memory that fails when it is told to, and that forgets at a crash what was not made durable.
//!
//! ```text
//!              every call is counted; the one of a given number fails ─► errors
//! code ─► MemoryDisk ─► what the code sees
//!              │ sync of a file, of a folder
//!              ▼
//!         what is durable ─► crash(random): that, and some of the rest, torn ─► another MemoryDisk
//! ```
//!
//! Source: the test files `test6.c` and `ioerr*.test` of `SQLite` (D. Richard Hipp and others); its page *How `SQLite` Is Tested*.

mod crash;
mod failure;
mod state;

use std::{
    io,
    path::{Path, PathBuf},
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
};

use corniche_store::{Disk, DiskFile, FileId, Hold, Listed, OpenMode};

pub use failure::Failure;

use crate::Random;
use state::{NameChange, Node, Owner, State};

/// A disk in memory. Clones are the same disk.
#[derive(Debug, Clone)]
pub struct MemoryDisk {
    state: Arc<Mutex<State>>,
    /// Something about held syncs has changed.
    syncs: Arc<Condvar>,
}

impl MemoryDisk {
    /// A disk that holds one folder, those around it, and nothing else.
    #[must_use]
    pub fn with_folder(folder: &Path) -> Self {
        Self::of(State::with_folder(folder))
    }

    fn of(state: State) -> Self {
        Self { state: Arc::new(Mutex::new(state)), syncs: Arc::default() }
    }

    /// What the store takes.
    #[must_use]
    pub fn disk(&self) -> Arc<dyn Disk> {
        Arc::new(self.clone())
    }

    /// How many calls there were so far, failed ones included.
    #[must_use]
    pub fn calls(&self) -> u64 {
        self.state().calls
    }

    /// Lets the call fail that comes after `calls` more have been made. One failure can be planned at a time.
    pub fn fail_after(&self, calls: u64, failure: Failure) {
        let mut state = self.state();
        state.planned = Some((state.calls + calls, failure));
    }

    /// Whether the planned failure has not come yet.
    #[must_use]
    pub fn is_failure_to_come(&self) -> bool {
        self.state().planned.is_some()
    }

    /// Ends [`Failure::Full`].
    pub fn make_room(&self) {
        self.state().is_full = false;
    }

    /// From here on syncs of files wait until [`Self::release_syncs`], as on a slow device.
    pub fn hold_syncs(&self) {
        self.state().holds_syncs = true;
    }

    /// Lets held syncs go on.
    pub fn release_syncs(&self) {
        self.state().holds_syncs = false;
        self.syncs.notify_all();
    }

    /// Waits until a thread is held in a sync.
    pub fn wait_for_held_sync(&self) {
        let mut state = self.state();
        while state.held_syncs == 0 {
            state = self.syncs.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// The disk as another process finds it when all that used it were killed, but the machine went on: nothing is lost, no lock is held.
    #[must_use]
    pub fn after_kill(&self) -> Self {
        Self::of(self.state().after_kill())
    }

    /// The disk after a loss of power: what was made durable, and of the rest whatever `random` likes.
    #[must_use]
    pub fn after_crash(&self, random: &mut Random) -> Self {
        Self::of(crash::crashed(&self.state(), random))
    }

    /// The paths of all files, ascending.
    #[must_use]
    pub fn paths(&self) -> Vec<PathBuf> {
        let state = self.state();
        let files = state.names.iter().filter(|(_, node)| matches!(node, Node::File(_)));
        files.map(|(path, _)| path.clone()).collect()
    }

    /// What a file holds; `None` if it is not there. Not counted as a call.
    #[must_use]
    pub fn content(&self, path: &Path) -> Option<Vec<u8>> {
        let state = self.state();
        state.file_at(path).map(|number| state.files[number].bytes.clone())
    }

    /// Sets what a file holds, durably; makes it where it is not there. Not counted as a call.
    pub fn set_content(&self, path: &Path, bytes: &[u8]) {
        let mut state = self.state();
        let number = match state.file_at(path) {
            Some(number) => number,
            None => state.add_file(path),
        };
        state.files[number].set(bytes);
        state.durable_names.insert(path.to_owned(), Node::File(number));
        state.changes.retain(|change| !change.names(path));
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Counts a call and lets it fail if it is its turn.
    fn call(&self, need: Need) -> io::Result<(MutexGuard<'_, State>, bool)> {
        let mut state = self.state();
        let is_short = state.count(need == Need::Room)?;
        Ok((state, is_short))
    }
}

/// Whether a call takes room on the disk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Need {
    Room,
    Nothing,
}

impl Disk for MemoryDisk {
    fn open(&self, path: &Path, mode: OpenMode) -> io::Result<Box<dyn DiskFile>> {
        let is_there = self.state().names.contains_key(path);
        let makes = !is_there && matches!(mode, OpenMode::New | OpenMode::ChangeOrNew);
        let (mut state, _) = self.call(if makes { Need::Room } else { Need::Nothing })?;
        let number = match state.names.get(path) {
            Some(_) if mode == OpenMode::New => return Err(io::ErrorKind::AlreadyExists.into()),
            Some(Node::Folder) => return Err(io::ErrorKind::IsADirectory.into()),
            Some(Node::File(number)) => *number,
            None if !makes => return Err(io::ErrorKind::NotFound.into()),
            None => {
                state.check_parent(path)?;
                state.add_file(path)
            }
        };
        let owner = state.next_owner();
        let can_write = mode != OpenMode::Read;
        Ok(Box::new(MemoryFile { disk: self.clone(), number, owner, can_write }))
    }

    fn create_folder(&self, path: &Path) -> io::Result<()> {
        let (mut state, _) = self.call(Need::Room)?;
        state.check_parent(path)?;
        if state.names.contains_key(path) {
            return Err(io::ErrorKind::AlreadyExists.into());
        }
        state.change(NameChange::Add { path: path.to_owned(), node: Node::Folder });
        Ok(())
    }

    fn list(&self, folder: &Path) -> io::Result<Vec<Listed>> {
        let (state, _) = self.call(Need::Nothing)?;
        state.check_folder(folder)?;
        let within = state.names.iter().filter(|(path, _)| path.parent() == Some(folder));
        let listed = within.map(|(path, node)| Listed {
            name: path.file_name().unwrap_or_default().to_owned(),
            is_folder: *node == Node::Folder,
        });
        Ok(listed.collect())
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        let (mut state, _) = self.call(Need::Room)?;
        state.file_at(from).ok_or(io::ErrorKind::NotFound)?;
        state.check_parent(to)?;
        state.change(NameChange::Rename { from: from.to_owned(), to: to.to_owned() });
        Ok(())
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        let (mut state, _) = self.call(Need::Nothing)?;
        state.file_at(path).ok_or(io::ErrorKind::NotFound)?;
        state.change(NameChange::Remove { path: path.to_owned() });
        Ok(())
    }

    fn remove_folder(&self, path: &Path) -> io::Result<()> {
        let (mut state, _) = self.call(Need::Nothing)?;
        state.check_folder(path)?;
        if state.names.keys().any(|other| other.parent() == Some(path)) {
            return Err(io::ErrorKind::DirectoryNotEmpty.into());
        }
        state.change(NameChange::Remove { path: path.to_owned() });
        Ok(())
    }

    fn sync_folder(&self, folder: &Path) -> io::Result<()> {
        let (mut state, _) = self.call(Need::Nothing)?;
        state.check_folder(folder)?;
        state.sync_folder(folder);
        Ok(())
    }

    fn identity(&self, path: &Path) -> io::Result<Option<FileId>> {
        let (state, _) = self.call(Need::Nothing)?;
        Ok(match state.names.get(path) {
            Some(Node::File(number)) => Some(FileId(0, *number as u64)),
            Some(Node::Folder) => Some(FileId(1, 0)),
            None => None,
        })
    }
}

/// An open file of a [`MemoryDisk`].
#[derive(Debug)]
struct MemoryFile {
    disk: MemoryDisk,
    number: usize,
    owner: Owner,
    can_write: bool,
}

impl DiskFile for MemoryFile {
    fn write_at(&self, bytes: &[u8], offset: u64) -> io::Result<usize> {
        let (mut state, is_short) = self.disk.call(Need::Room)?;
        if !self.can_write {
            return Err(io::ErrorKind::PermissionDenied.into());
        }
        let length = if is_short { bytes.len().div_ceil(2) } else { bytes.len() };
        state.files[self.number].write(offset as usize, &bytes[..length]);
        Ok(length)
    }

    fn read_at(&self, bytes: &mut [u8], offset: u64) -> io::Result<usize> {
        let (state, is_short) = self.disk.call(Need::Nothing)?;
        let all = &state.files[self.number].bytes;
        let rest = all.get(offset as usize..).unwrap_or_default();
        let length = rest.len().min(bytes.len());
        let length = if is_short { length.div_ceil(2) } else { length };
        bytes[..length].copy_from_slice(&rest[..length]);
        Ok(length)
    }

    fn length(&self) -> io::Result<u64> {
        let (state, _) = self.disk.call(Need::Nothing)?;
        Ok(state.files[self.number].bytes.len() as u64)
    }

    fn set_length(&self, length: u64) -> io::Result<()> {
        let (mut state, _) = self.disk.call(Need::Nothing)?;
        state.files[self.number].set_length(length as usize);
        Ok(())
    }

    fn sync(&self) -> io::Result<()> {
        let (mut state, _) = self.disk.call(Need::Nothing)?;
        state.held_syncs += 1;
        while state.holds_syncs {
            self.disk.syncs.notify_all();
            state = self.disk.syncs.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        state.held_syncs -= 1;
        state.files[self.number].sync();
        Ok(())
    }

    fn try_lock(&self, hold: Hold) -> io::Result<bool> {
        let (mut state, _) = self.disk.call(Need::Nothing)?;
        Ok(state.files[self.number].try_lock(self.owner, hold))
    }

    fn identity(&self) -> io::Result<FileId> {
        let _ = self.disk.call(Need::Nothing)?;
        Ok(FileId(0, self.number as u64))
    }
}

impl Drop for MemoryFile {
    fn drop(&mut self) {
        self.disk.state().files[self.number].unlock(self.owner);
    }
}
