//! The file system of the machine, behind the interface that tests replace.

use std::{
    fs::{self, File, Metadata, TryLockError},
    io,
    path::Path,
};

#[cfg(unix)]
use crate::output_target::own_files::system::OwnFolder;
use crate::{Disk, DiskFile, FileId, FolderItem, Hold, OpenMode, sync_folder};

/// The file system of the machine.
///
/// On Unix each call about a file opens the folder around it again, without following a link at the
/// folder's name. No handle is kept from one call to the next: the head of `own_files.rs` describes
/// what this does not protect from.
#[derive(Debug, Clone, Copy, Default)]
pub struct SystemDisk;

impl Disk for SystemDisk {
    #[cfg(unix)]
    fn open(&self, path: &Path, mode: OpenMode) -> io::Result<Box<dyn DiskFile>> {
        let (folder, name) = OwnFolder::around(path)?;
        Ok(Box::new(SystemFile(folder.open_file(name, path, mode)?)))
    }

    #[cfg(not(unix))]
    fn open(&self, path: &Path, mode: OpenMode) -> io::Result<Box<dyn DiskFile>> {
        Ok(Box::new(SystemFile(crate::open_own(path, mode)?)))
    }

    fn create_folder(&self, path: &Path) -> io::Result<()> {
        fs::create_dir(path)
    }

    #[cfg(unix)]
    fn list(&self, folder: &Path) -> io::Result<Vec<FolderItem>> {
        OwnFolder::open(folder)?.list()
    }

    #[cfg(not(unix))]
    fn list(&self, folder: &Path) -> io::Result<Vec<FolderItem>> {
        fs::read_dir(folder)?
            .map(|entry| {
                let entry = entry?;
                Ok(FolderItem { name: entry.file_name(), is_folder: entry.file_type()?.is_dir() })
            })
            .collect()
    }

    #[cfg(unix)]
    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        let ((folder, from), (other, to)) = (OwnFolder::around(from)?, OwnFolder::around(to)?);
        folder.rename(from, (&other, to))
    }

    #[cfg(not(unix))]
    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        fs::rename(from, to)
    }

    #[cfg(unix)]
    fn remove(&self, path: &Path) -> io::Result<()> {
        let (folder, name) = OwnFolder::around(path)?;
        folder.remove(name)
    }

    #[cfg(not(unix))]
    fn remove(&self, path: &Path) -> io::Result<()> {
        fs::remove_file(path)
    }

    fn remove_folder(&self, path: &Path) -> io::Result<()> {
        fs::remove_dir(path)
    }

    fn sync_folder(&self, folder: &Path) -> io::Result<()> {
        sync_folder(folder)
    }

    #[cfg(unix)]
    fn identity(&self, path: &Path) -> io::Result<Option<FileId>> {
        let found = OwnFolder::around(path).and_then(|(folder, name)| folder.identity(name));
        absent_is_none(found)
    }

    /// On other systems only the existence of a file of this name can be determined.
    #[cfg(not(unix))]
    fn identity(&self, path: &Path) -> io::Result<Option<FileId>> {
        absent_is_none(fs::symlink_metadata(path).map(|_| FileId(0, 0)))
    }
}

fn absent_is_none(found: io::Result<FileId>) -> io::Result<Option<FileId>> {
    match found {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        found => found.map(Some),
    }
}

/// A file on the file system of the machine.
#[derive(Debug)]
struct SystemFile(File);

impl DiskFile for SystemFile {
    #[cfg(unix)]
    fn write_at(&self, bytes: &[u8], offset: u64) -> io::Result<usize> {
        std::os::unix::fs::FileExt::write_at(&self.0, bytes, offset)
    }

    #[cfg(windows)]
    fn write_at(&self, bytes: &[u8], offset: u64) -> io::Result<usize> {
        std::os::windows::fs::FileExt::seek_write(&self.0, bytes, offset)
    }

    #[cfg(unix)]
    fn read_at(&self, bytes: &mut [u8], offset: u64) -> io::Result<usize> {
        std::os::unix::fs::FileExt::read_at(&self.0, bytes, offset)
    }

    #[cfg(windows)]
    fn read_at(&self, bytes: &mut [u8], offset: u64) -> io::Result<usize> {
        std::os::windows::fs::FileExt::seek_read(&self.0, bytes, offset)
    }

    fn length(&self) -> io::Result<u64> {
        Ok(self.0.metadata()?.len())
    }

    fn set_length(&self, length: u64) -> io::Result<()> {
        self.0.set_len(length)
    }

    fn sync(&self) -> io::Result<()> {
        self.0.sync_data()
    }

    fn try_lock(&self, hold: Hold) -> io::Result<bool> {
        let taken = match hold {
            Hold::Alone => self.0.try_lock(),
            Hold::Shared => self.0.try_lock_shared(),
        };
        match taken {
            Ok(()) => Ok(true),
            Err(TryLockError::WouldBlock) => Ok(false),
            Err(TryLockError::Error(error)) => Err(error),
        }
    }

    fn identity(&self) -> io::Result<FileId> {
        Ok(file_id(&self.0.metadata()?))
    }
}

#[cfg(unix)]
fn file_id(metadata: &Metadata) -> FileId {
    use std::os::unix::fs::MetadataExt;
    FileId(metadata.dev(), metadata.ino())
}

/// On other systems only the existence of a file of this name can be determined.
#[cfg(not(unix))]
fn file_id(_: &Metadata) -> FileId {
    FileId(0, 0)
}
