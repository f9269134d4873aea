//! A disk in memory that can fail at any call, and that loses everything that is not durable in a
//! crash.
//!
//! ```text
//!              every call is counted; a planned one fails ─► errors
//! code ─► MemoryDisk ─► the content that the code sees
//!              │ sync of a file, of a folder
//!              ▼
//!         durable content ─► crash(random): plus a torn part of the rest ─► another MemoryDisk
//! ```
//!
//! Source: the test files `test6.c` and `ioerr*.test` of `SQLite` (D. Richard Hipp and others); its
//! page *How `SQLite` Is Tested*.

mod crash;
mod failure;
mod state;

use std::{
    io,
    path::{Path, PathBuf},
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
};

use corniche_store::{Disk, DiskFile, FileId, FolderItem, Hold, OpenMode};

pub use failure::DiskFailure;

use crate::Random;
use state::{DiskNode, FileOwner, NameChange, State};

/// A disk in memory. Clones are the same disk.
#[derive(Debug, Clone)]
pub struct MemoryDisk {
    state: Arc<Mutex<State>>,
    /// Notified when a sync begins to wait or syncs are released.
    syncs: Arc<Condvar>,
}

impl MemoryDisk {
    /// Creates a disk with one folder and its parent folders, and nothing else.
    #[must_use]
    pub fn with_folder(folder: &Path) -> Self {
        Self::from_state(State::with_folder(folder))
    }

    fn from_state(state: State) -> Self {
        Self { state: Arc::new(Mutex::new(state)), syncs: Arc::default() }
    }

    /// Returns the disk as the interface of the store.
    #[must_use]
    pub fn disk(&self) -> Arc<dyn Disk> {
        Arc::new(self.clone())
    }

    /// The number of calls so far, including failed ones.
    #[must_use]
    pub fn calls(&self) -> u64 {
        self.state().calls
    }

    /// Lets a call fail after `calls` more calls. One failure can be planned at a time.
    pub fn fail_after(&self, calls: u64, failure: DiskFailure) {
        let mut state = self.state();
        state.planned = Some((state.calls + calls, failure));
    }

    /// Whether the planned failure has not occurred yet.
    #[must_use]
    pub fn is_failure_to_come(&self) -> bool {
        self.state().planned.is_some()
    }

    /// Ends [`DiskFailure::Full`].
    pub fn make_room(&self) {
        self.state().is_full = false;
    }

    /// From now on, syncs of files wait until [`Self::release_syncs`], as on a slow device.
    pub fn hold_syncs(&self) {
        self.state().holds_syncs = true;
    }

    /// Lets waiting syncs continue.
    pub fn release_syncs(&self) {
        self.state().holds_syncs = false;
        self.syncs.notify_all();
    }

    /// Waits until a thread waits in a sync.
    pub fn wait_for_held_sync(&self) {
        let mut state = self.state();
        while state.held_syncs == 0 {
            state = self.syncs.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Returns the disk as another process finds it after all its users were killed while the
    /// machine continued: nothing is lost, no lock is held.
    #[must_use]
    pub fn after_kill(&self) -> Self {
        Self::from_state(self.state().after_kill())
    }

    /// Returns the disk after a loss of power: everything that was durable, and a random part of
    /// the rest.
    #[must_use]
    pub fn after_crash(&self, random: &mut Random) -> Self {
        Self::from_state(crash::crashed(&self.state(), random))
    }

    /// The paths of all files, ascending.
    #[must_use]
    pub fn paths(&self) -> Vec<PathBuf> {
        let state = self.state();
        let files = state.names.iter().filter(|(_, node)| matches!(node, DiskNode::File(_)));
        files.map(|(path, _)| path.clone()).collect()
    }

    /// The content of a file; `None` if it does not exist. Not counted as a call.
    #[must_use]
    pub fn content(&self, path: &Path) -> Option<Vec<u8>> {
        let state = self.state();
        state.file_at(path).map(|number| state.files[number].bytes.clone())
    }

    /// Sets the content of a file durably, and creates the file if it does not exist. Not counted
    /// as a call.
    pub fn set_content(&self, path: &Path, bytes: &[u8]) {
        let mut state = self.state();
        let number = match state.file_at(path) {
            Some(number) => number,
            None => state.add_file(path),
        };
        state.files[number].set(bytes);
        state.durable_names.insert(path.to_owned(), DiskNode::File(number));
        state.changes.retain(|change| !change.names(path));
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Counts a call, and fails if its failure is planned.
    fn call(&self, need: Need) -> io::Result<(MutexGuard<'_, State>, bool)> {
        let mut state = self.state();
        let is_short = state.count(need == Need::Room)?;
        Ok((state, is_short))
    }
}

/// Whether a call needs disk space.
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
            Some(DiskNode::Folder) => return Err(io::ErrorKind::IsADirectory.into()),
            Some(DiskNode::File(number)) => *number,
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
        state.change(NameChange::Add { path: path.to_owned(), node: DiskNode::Folder });
        Ok(())
    }

    fn list(&self, folder: &Path) -> io::Result<Vec<FolderItem>> {
        let (state, _) = self.call(Need::Nothing)?;
        state.check_folder(folder)?;
        let within = state.names.iter().filter(|(path, _)| path.parent() == Some(folder));
        let listed = within.map(|(path, node)| FolderItem {
            name: path.file_name().unwrap_or_default().to_owned(),
            is_folder: *node == DiskNode::Folder,
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
            Some(DiskNode::File(number)) => Some(FileId(0, *number as u64)),
            Some(DiskNode::Folder) => Some(FileId(1, 0)),
            None => None,
        })
    }
}

/// An open file of a [`MemoryDisk`].
#[derive(Debug)]
struct MemoryFile {
    disk: MemoryDisk,
    number: usize,
    owner: FileOwner,
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
