//! The operations that the store needs of a file system; they are few enough for a test double.

use std::{ffi::OsString, fmt, io, path::Path};

/// Files and folders. All input and output of this crate uses this interface: a test double can let
/// any call fail, or lose everything that was not made durable.
///
/// A call may fail with [`io::ErrorKind::Interrupted`] and be repeated; writes and reads may be
/// short. Callers handle both.
pub trait Disk: fmt::Debug + Send + Sync {
    /// Opens a file.
    ///
    /// # Errors
    /// When the file exists ([`OpenMode::New`]) or does not exist ([`OpenMode::Read`],
    /// [`OpenMode::Change`]), or the device fails.
    fn open(&self, path: &Path, mode: OpenMode) -> io::Result<Box<dyn DiskFile>>;

    /// Creates a folder in an existing folder.
    ///
    /// # Errors
    /// With kind `AlreadyExists` if something of this name exists; otherwise when the device fails.
    fn create_folder(&self, path: &Path) -> io::Result<()>;

    /// Lists the content of a folder, in any order.
    ///
    /// # Errors
    /// With kind `NotFound` if the folder does not exist; otherwise when the device fails.
    fn list(&self, folder: &Path) -> io::Result<Vec<FolderItem>>;

    /// Renames a file atomically; an existing file of the new name is replaced.
    ///
    /// # Errors
    /// When the file does not exist or the device fails.
    fn rename(&self, from: &Path, to: &Path) -> io::Result<()>;

    /// Deletes a file.
    ///
    /// # Errors
    /// When the file does not exist or the device fails.
    fn remove(&self, path: &Path) -> io::Result<()>;

    /// Deletes an empty folder.
    ///
    /// # Errors
    /// When the folder does not exist or is not empty, or the device fails.
    fn remove_folder(&self, path: &Path) -> io::Result<()>;

    /// Makes the names in a folder durable, but not the content of its files.
    ///
    /// # Errors
    /// When the device fails.
    fn sync_folder(&self, folder: &Path) -> io::Result<()>;

    /// Returns which file has this name now; `None` if there is none.
    ///
    /// # Errors
    /// When the device fails.
    fn identity(&self, path: &Path) -> io::Result<Option<FileId>>;
}

/// An open file. Many threads may use it at once. Dropping it closes it and releases its lock.
pub trait DiskFile: fmt::Debug + Send + Sync {
    /// Writes some of `bytes`; returns how many.
    ///
    /// # Errors
    /// When there is no space or the device fails.
    fn write_at(&self, bytes: &[u8], offset: u64) -> io::Result<usize>;

    /// Reads some of the bytes at `offset`; returns how many, 0 at the end of the file.
    ///
    /// # Errors
    /// When the device fails.
    fn read_at(&self, bytes: &mut [u8], offset: u64) -> io::Result<usize>;

    /// Returns the length of the file in bytes.
    ///
    /// # Errors
    /// When the device fails.
    fn length(&self) -> io::Result<u64>;

    /// Truncates the file, or extends it with zeros.
    ///
    /// # Errors
    /// When the device fails.
    fn set_length(&self, length: u64) -> io::Result<()>;

    /// Makes the content and the length of the file durable, but not its name.
    ///
    /// # Errors
    /// When the device fails. Earlier writes may then be lost even if a later call succeeds.
    fn sync(&self) -> io::Result<()>;

    /// Takes an advisory lock that the kernel releases when the process ends; `false` if another
    /// open file holds it.
    ///
    /// # Errors
    /// When the file system has no locks or the device fails.
    fn try_lock(&self, hold: Hold) -> io::Result<bool>;

    /// Returns the identity of the file, whatever its name is now.
    ///
    /// # Errors
    /// When the device fails.
    fn identity(&self) -> io::Result<FileId>;
}

/// How a file is opened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OpenMode {
    /// Opens an existing file for reading.
    Read,
    /// Opens an existing file for reading and writing.
    Change,
    /// Creates a file for reading and writing; it must not exist yet.
    New,
    /// Opens a file for reading and writing, and creates it if it does not exist.
    ChangeOrNew,
}

/// How a lock is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hold {
    /// One holder has the lock alone.
    Alone,
    /// Any number of holders share the lock, and nobody holds it alone.
    Shared,
}

/// An entry of a folder.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct FolderItem {
    /// The name, without the folder.
    pub name: OsString,
    /// Whether the entry is a folder.
    pub is_folder: bool,
}

/// Distinguishes files that have had the same name, by device and number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FileId(pub u64, pub u64);
