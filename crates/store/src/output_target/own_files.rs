//! Opens Corniche's files in folders that others may have prepared: no link is followed, no call
//! blocks, and an existing file must be a regular file of this user.
//!
//! On Unix a file in one of these folders is opened, renamed and deleted by a handle of the folder,
//! which is opened without following a link, too. This protects the last two components of a path
//! during one call. Each call opens the folder again by its path: links further up are followed,
//! and a folder that is exchanged between two calls is not detected. Folders themselves are
//! created, deleted and made durable by their paths; the system follows no link when it creates or
//! deletes one.
//!
//! On other systems only the file's own name is protected: links to folders are followed, and the
//! owner of a file is not checked.

use std::{
    fs::{self, File, FileType},
    io,
    path::Path,
};

use crate::OpenMode;

/// Opens a file of Corniche. The path of its folder may contain links, as the user chose it; the
/// file's own name must not be a link.
///
/// # Errors
/// With kinds `NotFound` and `AlreadyExists` according to `mode`; when the existing file is not a
/// regular file, or does not belong to this user.
pub fn open_own(path: &Path, mode: OpenMode) -> io::Result<File> {
    checked(system::open(path, mode), path, mode)
}

/// Creates a folder that only this user can access, or accepts an existing folder of this kind: for
/// predictable names in folders to which everybody can write.
///
/// # Errors
/// When the folder cannot be created, or something else has its name.
pub fn make_own_folder(path: &Path) -> io::Result<()> {
    match system::create_private_folder(path) {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
            let found = path.symlink_metadata()?;
            match name_of(found.file_type()) {
                _ if found.is_dir() => system::check_owner_of_folder(&found, path),
                name => Err(in_the_way(path, &format!("it is {}", name.unwrap_or("a file")))),
            }
        }
        made => made,
    }
}

/// Returns the folder of a file, which need not exist: the working folder if the path has none.
#[must_use]
pub fn folder_of(file: &Path) -> &Path {
    file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Makes the names in a folder durable.
///
/// # Errors
/// When the disk fails.
#[cfg(unix)]
pub fn sync_folder(folder: &Path) -> io::Result<()> {
    File::open(folder)?.sync_all()
}

/// On other systems a folder cannot be opened as a file; its names become durable when the system
/// decides.
///
/// # Errors
/// None.
#[cfg(not(unix))]
pub fn sync_folder(_: &Path) -> io::Result<()> {
    Ok(())
}

/// Makes all files below a folder durable, and the folder itself; returns the number of bytes of
/// its files.
///
/// On Linux the whole file system is synced: tens of thousands of small files, one after another,
/// would take minutes. Before Linux 5.8 this call does not report failed writes.
///
/// # Errors
/// When the disk fails.
pub fn sync_tree(folder: &Path) -> io::Result<u64> {
    #[cfg(target_os = "linux")]
    match rustix::fs::syncfs(File::open(folder)?) {
        // Programs that emulate Linux may not support this call.
        Err(rustix::io::Errno::NOSYS) => {}
        synced => {
            synced?;
            return bytes_below(folder, &|_| Ok(()));
        }
    }
    bytes_below(folder, &|path| {
        if path.is_dir() { sync_folder(path) } else { File::open(path)?.sync_all() }
    })
}

/// Returns the number of bytes of the files below a folder. `sync` is called for each file, and for
/// each folder after its content.
fn bytes_below(folder: &Path, sync: &impl Fn(&Path) -> io::Result<()>) -> io::Result<u64> {
    let mut bytes = 0;
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        if entry.file_type()?.is_dir() {
            bytes += bytes_below(&entry.path(), sync)?;
        } else {
            bytes += entry.metadata()?.len();
            sync(&entry.path())?;
        }
    }
    sync(folder)?;
    Ok(bytes)
}

/// Returns the error about a path that is in the way.
pub(crate) fn in_the_way(path: &Path, what: &str) -> io::Error {
    let told = format!("{path:?} is in the way: {what}; check it and move it away");
    io::Error::new(io::ErrorKind::InvalidInput, told)
}

/// Whether something of this name exists, including a link to a file that does not exist.
pub(crate) fn is_there(path: &Path) -> bool {
    path.symlink_metadata().is_ok()
}

/// Returns an opened file if it may be used.
fn checked(opened: io::Result<File>, path: &Path, mode: OpenMode) -> io::Result<File> {
    let file = match opened {
        Ok(file) => file,
        // Systems have different errors for a link that is not followed, and for a socket that is
        // opened.
        Err(error)
            if !matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::AlreadyExists) =>
        {
            let kind = path.symlink_metadata().map(|found| found.file_type());
            let name = kind.ok().and_then(name_of);
            return Err(name.map_or(error, |name| in_the_way(path, &format!("it is {name}"))));
        }
        Err(error) => return Err(error),
    };
    let found = file.metadata()?;
    if let Some(name) = name_of(found.file_type()) {
        return Err(in_the_way(path, &format!("it is {name}")));
    }
    if matches!(mode, OpenMode::Change | OpenMode::ChangeOrNew) {
        system::check_owner(&found, path)?;
    }
    Ok(file)
}

/// Describes something that is not a regular file.
fn name_of(kind: FileType) -> Option<&'static str> {
    match kind {
        kind if kind.is_file() => None,
        kind if kind.is_symlink() => Some("a symbolic link, which is not followed here"),
        kind if kind.is_dir() => Some("a folder"),
        _ => Some("a pipe, a socket or a device"),
    }
}

#[cfg(unix)]
pub(crate) mod system {
    //! The system calls for Unix.

    use std::{
        ffi::{OsStr, OsString},
        fs::{self, File, Metadata},
        io,
        os::unix::{
            ffi::OsStringExt as _,
            fs::{DirBuilderExt as _, MetadataExt as _},
        },
        path::Path,
    };

    use rustix::{
        fd::OwnedFd,
        fs::{AtFlags, Dir, FileType, Mode, OFlags, openat, renameat, statat, unlinkat},
        process::geteuid,
    };

    use super::{checked, folder_of, in_the_way, is_there};
    use crate::{FileId, FolderItem, OpenMode};

    /// The flags for every file: its name is not a link, and opening a pipe does not wait for its
    /// other end.
    const SAFELY: OFlags = OFlags::NOFOLLOW.union(OFlags::NONBLOCK).union(OFlags::CLOEXEC);
    /// The permissions of new files, minus those that the process masks.
    const PERMISSIONS: Mode = Mode::from_raw_mode(0o666);

    fn flags_of(mode: OpenMode) -> OFlags {
        SAFELY
            | match mode {
                OpenMode::Read => OFlags::RDONLY,
                OpenMode::Change => OFlags::RDWR,
                OpenMode::New => OFlags::RDWR | OFlags::CREATE | OFlags::EXCL,
                OpenMode::ChangeOrNew => OFlags::RDWR | OFlags::CREATE,
            }
    }

    pub(crate) fn open(path: &Path, mode: OpenMode) -> io::Result<File> {
        let open = || rustix::fs::open(path, flags_of(mode), PERMISSIONS);
        Ok(rustix::io::retry_on_intr(open)?.into())
    }

    /// Fails unless a file belongs to this user and has one name: a second name may belong to a
    /// file that must not be changed.
    pub(crate) fn check_owner(found: &Metadata, path: &Path) -> io::Result<()> {
        if found.nlink() > 1 {
            return Err(in_the_way(path, "the same file has a second name elsewhere"));
        }
        // Some file systems assign all files to one user, whoever creates them.
        if found.uid() != geteuid().as_raw() && found.uid() != owner_of_new(folder_of(path))? {
            return Err(in_the_way(path, "it belongs to another user"));
        }
        Ok(())
    }

    pub(crate) fn create_private_folder(path: &Path) -> io::Result<()> {
        fs::DirBuilder::new().mode(0o700).create(path)
    }

    pub(crate) fn check_owner_of_folder(found: &Metadata, path: &Path) -> io::Result<()> {
        if found.uid() == geteuid().as_raw() || found.uid() == owner_of_new(path)? {
            return Ok(());
        }
        Err(in_the_way(path, "it belongs to another user"))
    }

    /// Returns the owner of a file that is created in a folder.
    fn owner_of_new(folder: &Path) -> io::Result<u32> {
        Ok(tempfile::tempfile_in(folder)?.metadata()?.uid())
    }

    /// A folder that was opened without following a link at its name.
    pub(crate) struct OwnFolder(OwnedFd);

    impl OwnFolder {
        pub(crate) fn open(path: &Path) -> io::Result<Self> {
            let flags = SAFELY | OFlags::DIRECTORY | OFlags::RDONLY;
            rustix::fs::open(path, flags, Mode::empty()).map(Self).map_err(|error| {
                let error = io::Error::from(error);
                let is_link = path.symlink_metadata().is_ok_and(|found| found.is_symlink());
                if is_link {
                    in_the_way(path, "it is a symbolic link, which is not followed here")
                } else {
                    error
                }
            })
        }

        /// Opens the folder around a file, and returns the file's name in it.
        pub(crate) fn around(path: &Path) -> io::Result<(Self, &OsStr)> {
            let name = path.file_name().ok_or(io::ErrorKind::InvalidFilename)?;
            Ok((Self::open(folder_of(path))?, name))
        }

        /// Opens the file `name`; `path` is its path in messages.
        pub(crate) fn open_file(
            &self,
            name: &OsStr,
            path: &Path,
            mode: OpenMode,
        ) -> io::Result<File> {
            let open = || openat(&self.0, name, flags_of(mode), PERMISSIONS);
            let opened = rustix::io::retry_on_intr(open).map(File::from);
            checked(opened.map_err(io::Error::from), path, mode)
        }

        pub(crate) fn list(&self) -> io::Result<Vec<FolderItem>> {
            let mut listed = Vec::new();
            for entry in Dir::read_from(&self.0)? {
                let entry = entry?;
                let name = entry.file_name();
                if matches!(name.to_bytes(), b"." | b"..") {
                    continue;
                }
                let kind = match entry.file_type() {
                    FileType::Unknown => {
                        let found = statat(&self.0, name, AtFlags::SYMLINK_NOFOLLOW)?;
                        FileType::from_raw_mode(found.st_mode)
                    }
                    known => known,
                };
                let name = OsString::from_vec(name.to_bytes().to_vec());
                listed.push(FolderItem { name, is_folder: kind == FileType::Directory });
            }
            Ok(listed)
        }

        /// Renames the file `from` in this folder to `to` in another opened folder.
        pub(crate) fn rename(&self, from: &OsStr, (folder, to): (&Self, &OsStr)) -> io::Result<()> {
            Ok(renameat(&self.0, from, &folder.0, to)?)
        }

        pub(crate) fn remove(&self, name: &OsStr) -> io::Result<()> {
            Ok(unlinkat(&self.0, name, AtFlags::empty())?)
        }

        pub(crate) fn identity(&self, name: &OsStr) -> io::Result<FileId> {
            let found = statat(&self.0, name, AtFlags::SYMLINK_NOFOLLOW)?;
            // The standard library does the same: systems have different types for these numbers.
            #[allow(clippy::unnecessary_cast, reason = "they are i32 on macOS, and u64 on Linux")]
            Ok(FileId(found.st_dev as u64, found.st_ino as u64))
        }
    }

    /// Whether an open file still has this name.
    pub(crate) fn is_at(file: &File, path: &Path) -> io::Result<bool> {
        if !is_there(path) {
            return Ok(false);
        }
        let (named, file) = (fs::symlink_metadata(path)?, file.metadata()?);
        Ok((file.dev(), file.ino()) == (named.dev(), named.ino()))
    }
}

#[cfg(not(unix))]
pub(crate) mod system {
    //! The system calls for Windows, as far as they go.

    use std::{
        fs::{File, Metadata},
        io,
        os::windows::fs::OpenOptionsExt as _,
        path::Path,
    };

    use crate::OpenMode;

    /// `FILE_FLAG_OPEN_REPARSE_POINT`: opens a link itself, not the file to which it points.
    const NO_FOLLOWING: u32 = 0x0020_0000;

    pub(crate) fn open(path: &Path, mode: OpenMode) -> io::Result<File> {
        let mut options = File::options();
        options.read(true).write(mode != OpenMode::Read).custom_flags(NO_FOLLOWING);
        match mode {
            OpenMode::Read | OpenMode::Change => &mut options,
            OpenMode::New => options.create_new(true),
            OpenMode::ChangeOrNew => options.create(true),
        };
        options.open(path)
    }

    /// The owner is not checked on this system.
    pub(crate) fn check_owner(_: &Metadata, _: &Path) -> io::Result<()> {
        Ok(())
    }

    pub(crate) fn create_private_folder(path: &Path) -> io::Result<()> {
        std::fs::create_dir(path)
    }

    pub(crate) fn check_owner_of_folder(_: &Metadata, _: &Path) -> io::Result<()> {
        Ok(())
    }

    /// On this system an open file keeps its name.
    pub(crate) fn is_at(_: &File, _: &Path) -> io::Result<bool> {
        Ok(true)
    }
}
