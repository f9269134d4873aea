//! Files as the rest of the crate uses them: interrupted calls are repeated, short writes and reads
//! are completed, and errors name their file.

use std::{
    io,
    path::{Path, PathBuf},
    sync::Arc,
};

use crate::{Disk, DiskFile, FolderItem, Hold, OpenMode, PartFile, StoreError};

/// A disk.
#[derive(Debug)]
pub(crate) struct Files {
    disk: Arc<dyn Disk>,
}

impl Files {
    pub(crate) fn new(disk: Arc<dyn Disk>) -> Arc<Self> {
        Arc::new(Self { disk })
    }

    /// Opens a file. The caller may handle errors of kind `AlreadyExists`; see [`is_kind`].
    pub(crate) fn open(
        self: &Arc<Self>,
        path: &Path,
        mode: OpenMode,
    ) -> Result<OpenFile, StoreError> {
        let doing = if mode == OpenMode::New { "create" } else { "open" };
        let file = named(path, doing, || self.disk.open(path, mode))?;
        Ok(OpenFile { file, path: path.to_owned(), files: Arc::clone(self) })
    }

    /// Opens a file that need not exist; `None` if it does not.
    pub(crate) fn open_if_there(
        self: &Arc<Self>,
        path: &Path,
        mode: OpenMode,
    ) -> Result<Option<OpenFile>, StoreError> {
        absent_is_none(self.open(path, mode))
    }

    /// Creates a folder unless it exists.
    pub(crate) fn create_folder(&self, path: &Path) -> Result<(), StoreError> {
        match named(path, "create the folder", || self.disk.create_folder(path)) {
            Err(error) if is_kind(&error, io::ErrorKind::AlreadyExists) => Ok(()),
            result => result,
        }
    }

    /// Lists the content of a folder, sorted by name; `None` if the folder does not exist.
    pub(crate) fn list(&self, folder: &Path) -> Result<Option<Vec<FolderItem>>, StoreError> {
        let mut listed = absent_is_none(named(folder, "list", || self.disk.list(folder)))?;
        if let Some(listed) = &mut listed {
            listed.sort();
        }
        Ok(listed)
    }

    pub(crate) fn rename(&self, from: &Path, to: &Path) -> Result<(), StoreError> {
        named(from, "rename", || self.disk.rename(from, to))
    }

    /// Deletes a file if it exists.
    pub(crate) fn remove(&self, path: &Path) -> Result<(), StoreError> {
        absent_is_none(named(path, "remove", || self.disk.remove(path))).map(drop)
    }

    /// Deletes an empty folder if it exists.
    pub(crate) fn remove_folder(&self, path: &Path) -> Result<(), StoreError> {
        absent_is_none(named(path, "remove the folder", || self.disk.remove_folder(path))).map(drop)
    }

    pub(crate) fn sync_folder(&self, folder: &Path) -> Result<(), StoreError> {
        named(folder, "sync", || self.disk.sync_folder(folder))
    }

    pub(crate) fn exists(&self, path: &Path) -> Result<bool, StoreError> {
        Ok(named(path, "inspect", || self.disk.identity(path))?.is_some())
    }
}

/// An open file and its path.
#[derive(Debug)]
pub(crate) struct OpenFile {
    file: Box<dyn DiskFile>,
    path: PathBuf,
    files: Arc<Files>,
}

impl OpenFile {
    pub(crate) fn files(&self) -> &Arc<Files> {
        &self.files
    }

    pub(crate) fn write_all_at(&self, mut bytes: &[u8], mut offset: u64) -> Result<(), StoreError> {
        while !bytes.is_empty() {
            let written = named(&self.path, "write", || match self.file.write_at(bytes, offset) {
                Ok(0) => Err(io::ErrorKind::WriteZero.into()),
                written => written,
            })?;
            bytes = &bytes[written..];
            offset += written as u64;
        }
        Ok(())
    }

    /// Reads at most the first `most` bytes of the file.
    pub(crate) fn read_start(&self, most: u64) -> Result<Vec<u8>, StoreError> {
        let mut bytes = vec![0; self.length()?.min(most) as usize];
        self.read_exact_at(&mut bytes, 0)?;
        Ok(bytes)
    }

    /// Reads up to the end of `bytes` or of the file; returns the number of bytes read.
    pub(crate) fn read_up_to(&self, bytes: &mut [u8], offset: u64) -> Result<usize, StoreError> {
        let mut length = 0;
        while length < bytes.len() {
            let rest = &mut bytes[length..];
            let read =
                named(&self.path, "read", || self.file.read_at(rest, offset + length as u64))?;
            if read == 0 {
                break;
            }
            length += read;
        }
        Ok(length)
    }

    pub(crate) fn set_length(&self, length: u64) -> Result<(), StoreError> {
        named(&self.path, "set the length of", || self.file.set_length(length))
    }

    pub(crate) fn sync(&self) -> Result<(), StoreError> {
        named(&self.path, "sync", || self.file.sync())
    }

    /// Takes the lock of the file; `false` if another process holds it.
    pub(crate) fn try_lock(&self, hold: Hold) -> Result<bool, StoreError> {
        named(&self.path, "lock", || self.file.try_lock(hold))
    }

    /// Whether the path still leads to this file.
    pub(crate) fn is_in_place(&self) -> Result<bool, StoreError> {
        let own = named(&self.path, "inspect", || self.file.identity())?;
        let named_so = named(&self.path, "inspect", || self.files.disk.identity(&self.path))?;
        Ok(named_so == Some(own))
    }
}

impl PartFile for OpenFile {
    fn path(&self) -> &Path {
        &self.path
    }

    fn length(&self) -> Result<u64, StoreError> {
        named(&self.path, "get the length of", || self.file.length())
    }

    fn read_exact_at(&self, bytes: &mut [u8], offset: u64) -> Result<(), StoreError> {
        if self.read_up_to(bytes, offset)? == bytes.len() {
            return Ok(());
        }
        named(&self.path, "read", || Err(io::ErrorKind::UnexpectedEof.into()))
    }
}

/// Whether an error is about a file and has this kind.
pub(crate) fn is_kind(error: &StoreError, kind: io::ErrorKind) -> bool {
    matches!(error, StoreError::Io { source, .. } if source.kind() == kind)
}

fn absent_is_none<T>(result: Result<T, StoreError>) -> Result<Option<T>, StoreError> {
    match result {
        Err(error) if is_kind(&error, io::ErrorKind::NotFound) => Ok(None),
        result => result.map(Some),
    }
}

/// Repeats a call as long as it is interrupted, and adds the name of the file to an error.
fn named<T>(
    path: &Path,
    doing: &'static str,
    mut call: impl FnMut() -> io::Result<T>,
) -> Result<T, StoreError> {
    loop {
        match call() {
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            result => {
                return result.map_err(|source| StoreError::Io {
                    path: path.to_owned(),
                    doing,
                    source,
                });
            }
        }
    }
}
