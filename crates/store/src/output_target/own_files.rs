//! Files of ours in folders that others may have prepared: no link is followed, nothing is waited for, and what is there already is a regular
//! file of this user.
//!
//! On Unix a file of a folder that is ours is opened, renamed and removed by a handle of that folder, which is opened without following a link
//! either. That holds for the last two names of a path and for one call. Each call opens the folder anew by its path: links further up are
//! followed, and a folder that is exchanged for another between two calls is not noticed. Folders themselves are made, removed and made durable
//! by their paths; the system follows no link where it makes or removes one.
//!
//! Elsewhere only the file's own name is protected: links of folders are followed, and who owns a file is not asked.

use std::{
    fs::{self, File, FileType},
    io,
    path::Path,
};

use crate::OpenMode;

/// Opens a file of ours. The folder around it may be reached by links, as whoever names it wants it; the file's own name may not be one.
///
/// # Errors
/// Of kinds `NotFound` and `AlreadyExists` as `mode` says; where what is there is no regular file, or none of this user to be written.
pub fn open_own(path: &Path, mode: OpenMode) -> io::Result<File> {
    checked(system::open(path, mode), path, mode)
}

/// Makes a folder of this user's alone, or takes the one that is there if it is such a folder: for names that others can know beforehand, in
/// folders that all write to.
///
/// # Errors
/// Where it cannot be made, or something else has its name.
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

/// The folder that a file is in, or will be: the working folder where its name says none.
#[must_use]
pub fn folder_of(file: &Path) -> &Path {
    file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Makes the names in a folder durable.
///
/// # Errors
/// Where the disk fails.
#[cfg(unix)]
pub fn sync_folder(folder: &Path) -> io::Result<()> {
    File::open(folder)?.sync_all()
}

/// Elsewhere a folder cannot be opened as a file; its names are durable when the system says so.
///
/// # Errors
/// None.
#[cfg(not(unix))]
pub fn sync_folder(_: &Path) -> io::Result<()> {
    Ok(())
}

/// Makes all that is below a folder durable, and the folder; returns how many bytes its files have.
///
/// On Linux all of the file system is: tens of thousands of small files, one after the other, take minutes. Before Linux 5.8 it does not tell that writing
/// failed.
///
/// # Errors
/// Where the disk fails.
pub fn sync_tree(folder: &Path) -> io::Result<u64> {
    #[cfg(target_os = "linux")]
    match rustix::fs::syncfs(File::open(folder)?) {
        // Programs that stand in for Linux may not know this call.
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

/// How many bytes the files below a folder have. `sync` is called for each file, and for each folder after what is in it.
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

/// What stands in the way, in words.
pub(crate) fn in_the_way(path: &Path, what: &str) -> io::Error {
    let told = format!("{} is in the way: {what}; look at it and move it away", path.display());
    io::Error::new(io::ErrorKind::InvalidInput, told)
}

/// Whether something of this name is there, be it a link that leads nowhere.
pub(crate) fn is_there(path: &Path) -> bool {
    path.symlink_metadata().is_ok()
}

/// A file that was opened, if it is one to work in.
fn checked(opened: io::Result<File>, path: &Path, mode: OpenMode) -> io::Result<File> {
    let file = match opened {
        Ok(file) => file,
        // Systems have several words for a link that is not followed, and for a socket that is opened.
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

/// What something is that is no regular file.
fn name_of(kind: FileType) -> Option<&'static str> {
    match kind {
        kind if kind.is_file() => None,
        kind if kind.is_symlink() => Some("a link, which is not followed there"),
        kind if kind.is_dir() => Some("a folder"),
        _ => Some("a pipe, a socket or a device"),
    }
}

#[cfg(unix)]
pub(crate) mod system {
    //! The calls of Unix.

    use std::{
        ffi::{OsStr, OsString},
        fs::{self, File, Metadata},
        io,
        os::unix::{
            ffi::OsStringExt as _,
            fs::{DirBuilderExt as _, MetadataExt as _, OpenOptionsExt as _},
        },
        path::Path,
    };

    use rustix::{
        fd::OwnedFd,
        fs::{AtFlags, Dir, FileType, Mode, OFlags, openat, renameat, statat, unlinkat},
        process::geteuid,
    };

    use super::{checked, folder_of, in_the_way, is_there};
    use crate::{FileId, Listed, OpenMode};

    /// What is asked of every file: its name is no link, and opening a pipe does not wait for its other end.
    const SAFELY: OFlags = OFlags::NOFOLLOW.union(OFlags::NONBLOCK).union(OFlags::CLOEXEC);
    /// What files are made with, less what the process masks.
    const PERMISSIONS: Mode = Mode::from_raw_mode(0o666);

    pub(crate) fn open(path: &Path, mode: OpenMode) -> io::Result<File> {
        let mut options = File::options();
        options.read(true).write(mode != OpenMode::Read);
        options.custom_flags(SAFELY.bits().cast_signed());
        match mode {
            OpenMode::Read | OpenMode::Change => &mut options,
            OpenMode::New => options.create_new(true),
            OpenMode::ChangeOrNew => options.create(true),
        };
        options.open(path)
    }

    /// Fails unless a file is of this user and has one name: a second one may be that of a file which is dear to someone.
    pub(crate) fn check_owner(found: &Metadata, path: &Path) -> io::Result<()> {
        if found.nlink() > 1 {
            return Err(in_the_way(path, "the same file has a second name elsewhere"));
        }
        // Some file systems give all files to one user, whoever makes them.
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

    /// Whom a file belongs to that is made in a folder.
    fn owner_of_new(folder: &Path) -> io::Result<u32> {
        Ok(tempfile::tempfile_in(folder)?.metadata()?.uid())
    }

    /// A folder of ours, opened without following a link at its name.
    pub(crate) struct OwnFolder(OwnedFd);

    impl OwnFolder {
        pub(crate) fn open(path: &Path) -> io::Result<Self> {
            let flags = SAFELY | OFlags::DIRECTORY | OFlags::RDONLY;
            rustix::fs::open(path, flags, Mode::empty()).map(Self).map_err(|error| {
                let error = io::Error::from(error);
                let is_link = path.symlink_metadata().is_ok_and(|found| found.is_symlink());
                if is_link {
                    in_the_way(path, "it is a link, which is not followed there")
                } else {
                    error
                }
            })
        }

        /// The folder around a file, and the file's name in it.
        pub(crate) fn around(path: &Path) -> io::Result<(Self, &OsStr)> {
            let name = path.file_name().ok_or(io::ErrorKind::InvalidFilename)?;
            Ok((Self::open(folder_of(path))?, name))
        }

        /// Opens the file `name`; `path` is what it is called in messages.
        pub(crate) fn open_file(
            &self,
            name: &OsStr,
            path: &Path,
            mode: OpenMode,
        ) -> io::Result<File> {
            let flags = SAFELY
                | match mode {
                    OpenMode::Read => OFlags::RDONLY,
                    OpenMode::Change => OFlags::RDWR,
                    OpenMode::New => OFlags::RDWR | OFlags::CREATE | OFlags::EXCL,
                    OpenMode::ChangeOrNew => OFlags::RDWR | OFlags::CREATE,
                };
            let opened = openat(&self.0, name, flags, PERMISSIONS).map(File::from);
            checked(opened.map_err(io::Error::from), path, mode)
        }

        pub(crate) fn list(&self) -> io::Result<Vec<Listed>> {
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
                listed.push(Listed { name, is_folder: kind == FileType::Directory });
            }
            Ok(listed)
        }

        /// Gives the file `from` in this folder the name `to` in a folder of ours.
        pub(crate) fn rename(&self, from: &OsStr, (folder, to): (&Self, &OsStr)) -> io::Result<()> {
            Ok(renameat(&self.0, from, &folder.0, to)?)
        }

        pub(crate) fn remove(&self, name: &OsStr) -> io::Result<()> {
            Ok(unlinkat(&self.0, name, AtFlags::empty())?)
        }

        pub(crate) fn identity(&self, name: &OsStr) -> io::Result<FileId> {
            let found = statat(&self.0, name, AtFlags::SYMLINK_NOFOLLOW)?;
            // As the standard library does it: systems have these numbers in types of their own.
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
    //! The calls of Windows, as far as they go.

    use std::{
        fs::{File, Metadata},
        io,
        os::windows::fs::OpenOptionsExt as _,
        path::Path,
    };

    use crate::OpenMode;

    /// `FILE_FLAG_OPEN_REPARSE_POINT`: a link itself is opened, not what it leads to.
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

    /// Owners are not asked here.
    pub(crate) fn check_owner(_: &Metadata, _: &Path) -> io::Result<()> {
        Ok(())
    }

    pub(crate) fn create_private_folder(path: &Path) -> io::Result<()> {
        std::fs::create_dir(path)
    }

    pub(crate) fn check_owner_of_folder(_: &Metadata, _: &Path) -> io::Result<()> {
        Ok(())
    }

    /// An open file keeps its name here.
    pub(crate) fn is_at(_: &File, _: &Path) -> io::Result<bool> {
        Ok(true)
    }
}
