//! What the store needs of a file system, so small that a test can stand in for it.

use std::{ffi::OsString, fmt, io, path::Path};

/// Files and folders. Every input and output of this crate goes through it: a test double fails any call it likes, or forgets what was not
/// made durable.
///
/// A call may end with [`io::ErrorKind::Interrupted`] and be made again; writes and reads may be short. Who calls copes with both.
pub trait Disk: fmt::Debug + Send + Sync {
    /// Opens a file.
    ///
    /// # Errors
    /// Where the file is there ([`OpenMode::New`]) or not ([`OpenMode::Read`], [`OpenMode::Change`]), or the device fails.
    fn open(&self, path: &Path, mode: OpenMode) -> io::Result<Box<dyn DiskFile>>;

    /// Makes a folder within one that is there.
    ///
    /// # Errors
    /// Of kind `AlreadyExists` where there is something of this name; else where the device fails.
    fn create_folder(&self, path: &Path) -> io::Result<()>;

    /// What a folder holds, in any order.
    ///
    /// # Errors
    /// Of kind `NotFound` where it is not there; else where the device fails.
    fn list(&self, folder: &Path) -> io::Result<Vec<Listed>>;

    /// Gives a file another name at once; a file of that name is replaced.
    ///
    /// # Errors
    /// Where it is not there or the device fails.
    fn rename(&self, from: &Path, to: &Path) -> io::Result<()>;

    /// Removes a file.
    ///
    /// # Errors
    /// Where it is not there or the device fails.
    fn remove(&self, path: &Path) -> io::Result<()>;

    /// Removes an empty folder.
    ///
    /// # Errors
    /// Where it is not there, not empty, or the device fails.
    fn remove_folder(&self, path: &Path) -> io::Result<()>;

    /// Makes durable which names a folder holds. The content of its files is not meant.
    ///
    /// # Errors
    /// Where the device fails.
    fn sync_folder(&self, folder: &Path) -> io::Result<()>;

    /// Which file has this name now; `None` if there is none.
    ///
    /// # Errors
    /// Where the device fails.
    fn identity(&self, path: &Path) -> io::Result<Option<FileId>>;
}

/// An open file. Many threads may use it at once. Dropping it closes it and gives its lock back.
pub trait DiskFile: fmt::Debug + Send + Sync {
    /// Writes some of `bytes`; returns how many.
    ///
    /// # Errors
    /// Where there is no room or the device fails.
    fn write_at(&self, bytes: &[u8], offset: u64) -> io::Result<usize>;

    /// Reads some of the bytes at `offset`; returns how many, 0 at the end of the file.
    ///
    /// # Errors
    /// Where the device fails.
    fn read_at(&self, bytes: &mut [u8], offset: u64) -> io::Result<usize>;

    /// Its length, bytes.
    ///
    /// # Errors
    /// Where the device fails.
    fn length(&self) -> io::Result<u64>;

    /// Cuts it, or fills it up with zeros.
    ///
    /// # Errors
    /// Where the device fails.
    fn set_length(&self, length: u64) -> io::Result<()>;

    /// Makes its content and length durable; its name is not meant.
    ///
    /// # Errors
    /// Where the device fails. What was written before may then be lost even if a later call succeeds.
    fn sync(&self) -> io::Result<()>;

    /// Takes an advisory lock that the kernel gives back when the process ends; `false` if another open file holds it.
    ///
    /// # Errors
    /// Where the file system has no locks or the device fails.
    fn try_lock(&self, hold: Hold) -> io::Result<bool>;

    /// Which file it is, whatever its name is by now.
    ///
    /// # Errors
    /// Where the device fails.
    fn identity(&self) -> io::Result<FileId>;
}

/// How a file is opened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OpenMode {
    /// A file that is there, for reading.
    Read,
    /// A file that is there, for reading and writing.
    Change,
    /// A file that is not there yet, for reading and writing.
    New,
    /// The file is opened for reading and writing, and made where it is not there.
    ChangeOrNew,
}

/// How a lock is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hold {
    /// One holds it alone.
    Alone,
    /// Any number hold it, but then nobody alone.
    Shared,
}

/// One of the things a folder holds.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Listed {
    /// Its name, without the folder.
    pub name: OsString,
    /// Whether it is a folder itself.
    pub is_folder: bool,
}

/// Tells files apart that have had the same name: device and number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FileId(pub u64, pub u64);
