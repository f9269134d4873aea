//! Files that are written next to their target until they are complete, and how a later run
//! recognises them.
//!
//! ```text
//!   .NAME.unfinished          the claim: a line with a random id, written first; locked while a program writes
//!   .NAME.ID.unfinished       the unfinished file or folder
//!   .NAME.ID.replaced         the old folder, while the new one takes its place
//! ```
//!
//! A killed run leaves its claim, and with it the id: files with this id in their name belong to
//! Corniche, and no other files do. The next run takes over the claim. Any other file with the name
//! of the claim is left alone and reported.

use std::{
    fs::{self, File, TryLockError},
    io::{self, Read as _, Seek as _, Write as _},
    path::{Path, PathBuf},
};

use tempfile::{NamedTempFile, TempPath};

use super::own_files::{
    folder_of, in_the_way, is_there, open_own, sync_folder,
    system::{create_private_folder, is_at},
};
use crate::{
    OpenMode,
    ids::{Marked, marked, random_digits},
};

/// The number of attempts if another program ends at the same moment and deletes its claim.
const TRIES: usize = 5;
/// The beginning of a claim; the id and the end of the line follow.
const MARK: &str = "corniche unfinished ";
/// Longer files are not claims.
const MOST_BYTES: u64 = 100;
/// The ending of the unfinished file or folder.
const UNFINISHED: &str = "unfinished";
/// The ending of the replaced folder.
const REPLACED: &str = "replaced";

/// How to handle an existing file at a target.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Existing {
    /// Keeps the existing file; nothing is written.
    Keep,
    /// Replaces the existing file.
    Replace,
}

/// The right to write to a target, for as long as this value lives: a locked file next to the
/// target.
#[derive(Debug)]
pub struct Claim {
    target: PathBuf,
    path: PathBuf,
    file: File,
    id: String,
}

fn beside(target: &Path, id: &str, end: &str) -> PathBuf {
    let name = target.file_name().unwrap_or_default().to_string_lossy();
    target.with_file_name(format!(".{name}.{id}.{end}"))
}

/// The longest name of a file next to its target while the target is written.
pub(crate) fn longest_name(target: &Path) -> PathBuf {
    beside(target, &random_digits(), UNFINISHED)
}

impl Claim {
    /// Claims a target, which need not exist. Leftovers of a killed run next to it are neither used
    /// nor deleted by this.
    ///
    /// # Errors
    /// With kind `ResourceBusy` if another program writes there; otherwise when the folder cannot
    /// be written, or a file that does not belong to Corniche has the name of the claim.
    pub fn take(target: &Path) -> io::Result<Self> {
        let name = target.file_name().unwrap_or_default().to_string_lossy();
        let path = target.with_file_name(format!(".{name}.{UNFINISHED}"));
        for _ in 0..TRIES {
            let file = open_own(&path, OpenMode::ChangeOrNew)?;
            lock(&file)?;
            if !is_at(&file, &path)? {
                continue;
            }
            // The file becomes a claim, which is deleted when it is dropped, only after it is known
            // to be empty or to belong to Corniche.
            let text = read(&file)?;
            let said = marked(&text, MARK);
            let id = match said {
                Marked::Id(id, "") => id.to_owned(),
                Marked::Begun => random_digits(),
                Marked::Id(..) | Marked::Other => {
                    return Err(in_the_way(
                        &path,
                        "it was not created by this version of Corniche",
                    ));
                }
            };
            let mut claim = Self { target: target.to_path_buf(), path, file, id };
            if said == Marked::Begun {
                claim.sign()?;
            }
            return Ok(claim);
        }
        Err(busy())
    }

    /// The claimed target.
    #[must_use]
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// The locked file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The path of the unfinished file or folder that becomes the target.
    #[must_use]
    pub fn unfinished(&self) -> PathBuf {
        self.beside(UNFINISHED)
    }

    /// The path of the old folder while the new one takes its place.
    #[must_use]
    pub fn replaced(&self) -> PathBuf {
        self.beside(REPLACED)
    }

    fn beside(&self, end: &str) -> PathBuf {
        beside(&self.target, &self.id, end)
    }

    /// Begins the file that becomes the target. Leftovers of a killed run are deleted.
    ///
    /// # Errors
    /// When the folder cannot be written.
    pub fn begin_file(self, existing: Existing) -> io::Result<UnfinishedFile> {
        let path = self.unfinished();
        remove_left(&path)?;
        let file = open_own(&path, OpenMode::New)?;
        let file = NamedTempFile::from_parts(file, TempPath::try_from_path(path)?);
        Ok(UnfinishedFile { file, existing, claim: self })
    }

    /// Begins the folder that becomes the target, or contains the file that does. Leftovers of
    /// killed runs with this target are deleted.
    ///
    /// # Errors
    /// When the folder cannot be written.
    pub fn begin_folder(self) -> io::Result<UnfinishedFolder> {
        let path = self.unfinished();
        for left in [&path, &self.replaced()] {
            remove_left(left)?;
        }
        // Unfinished files are not for other users.
        create_private_folder(&path)?;
        Ok(UnfinishedFolder { path, claim: self })
    }

    /// Makes the claim durable, so that files with its id are recognised even after a failure of
    /// the machine.
    ///
    /// # Errors
    /// When the disk fails.
    pub fn sync(&self) -> io::Result<()> {
        self.file.sync_all()?;
        sync_folder(folder_of(&self.path))
    }

    /// Writes the claim, or completes one that was begun.
    fn sign(&mut self) -> io::Result<()> {
        self.file.set_len(0)?;
        self.file.rewind()?;
        self.file.write_all(format!("{MARK}{}\n", self.id).as_bytes())
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        // Only the claim identifies the remaining files; a later run deletes both.
        let is_needed =
            [UNFINISHED, REPLACED].map(|end| self.beside(end)).iter().any(|path| is_there(path));
        if !is_needed && is_at(&self.file, &self.path).unwrap_or(false) {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// A file that is written next to its target. It is deleted if it is dropped before it is moved
/// there.
#[derive(Debug)]
pub struct UnfinishedFile {
    // Dropped before the claim.
    file: NamedTempFile,
    existing: Existing,
    claim: Claim,
}

impl UnfinishedFile {
    /// The path of the unfinished file.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.file.path()
    }

    /// The path of the target.
    #[must_use]
    pub fn target(&self) -> &Path {
        &self.claim.target
    }

    /// Moves the finished file to its target, durably; returns its size.
    ///
    /// # Errors
    /// With kind `AlreadyExists` if the target exists and is to be kept; otherwise when the disk
    /// fails.
    pub fn place(self) -> io::Result<u64> {
        // The claim is held until the file is at its target.
        let Self { file, existing, claim } = self;
        place(file.into_temp_path(), &claim.target, existing)
    }
}

impl io::Write for UnfinishedFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// A folder that is written next to its target, which it becomes, or a file in it. It is deleted
/// when it is dropped; files that cannot be deleted are deleted by the next run with this target.
#[derive(Debug)]
pub struct UnfinishedFolder {
    path: PathBuf,
    claim: Claim,
}

impl UnfinishedFolder {
    /// The path of the folder.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The claim of the target, which is held as long as the folder is in use.
    #[must_use]
    pub fn claim(&self) -> &Claim {
        &self.claim
    }

    /// Gives the folder the permissions of any new folder, if it becomes the target itself. Until
    /// then only this user can access it.
    ///
    /// # Errors
    /// When the disk fails.
    pub fn open_to_others(&self) -> io::Result<()> {
        // The process's file mode mask can only be read by setting it, which affects all threads.
        let any = self.path.join(".permissions");
        fs::create_dir(&any)?;
        let permissions = any.metadata()?.permissions();
        fs::remove_dir(&any)?;
        fs::set_permissions(&self.path, permissions)
    }

    /// Moves a finished file of the folder to the target, durably; returns its size.
    ///
    /// # Errors
    /// Same as [`UnfinishedFile::place`].
    pub fn place_file(self, name: &str, existing: Existing) -> io::Result<u64> {
        place(TempPath::try_from_path(self.path.join(name))?, &self.claim.target, existing)
    }
}

impl Drop for UnfinishedFolder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.path);
    }
}

/// Reads the content of a file that has the name of a claim.
fn read(file: &File) -> io::Result<String> {
    let mut bytes = Vec::new();
    file.take(MOST_BYTES).read_to_end(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Syncs a finished file to disk, moves it to its target, and makes its name durable. Returns its
/// size.
fn place(path: TempPath, target: &Path, existing: Existing) -> io::Result<u64> {
    let file = open_own(&path, OpenMode::Read)?;
    file.sync_all()?;
    let bytes = file.metadata()?.len();
    let placed = match existing {
        Existing::Replace => path.persist(target),
        // This fails if a file was created at the target in the meantime.
        Existing::Keep => match path.persist_noclobber(target) {
            // Not every file system supports this. Without it, only the check at the start protects
            // an existing file.
            Err(refused) if refused.error.kind() != io::ErrorKind::AlreadyExists => {
                refused.path.persist(target)
            }
            placed => placed,
        },
    };
    placed.map_err(|refused| refused.error)?;
    sync_folder(folder_of(target))?;
    Ok(bytes)
}

fn busy() -> io::Error {
    io::Error::new(io::ErrorKind::ResourceBusy, "another program is writing it")
}

fn lock(file: &File) -> io::Result<()> {
    match file.try_lock() {
        Ok(()) => Ok(()),
        Err(TryLockError::WouldBlock) => Err(busy()),
        // Some network file systems have no locks. There the last program to finish wins.
        Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => Ok(()),
        Err(TryLockError::Error(error)) => Err(error),
    }
}

/// Deletes the leftovers of a killed run under a name with the id of its claim.
fn remove_left(path: &Path) -> io::Result<()> {
    match path.symlink_metadata() {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(error) => Err(error),
        Ok(found) if found.is_dir() => fs::remove_dir_all(path),
        Ok(_) => fs::remove_file(path),
    }
}

#[cfg(test)]
#[path = "claim_tests.rs"]
mod tests;
