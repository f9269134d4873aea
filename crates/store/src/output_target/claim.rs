//! What is written beside its target until it is complete, and how a later run knows it for ours.
//!
//! ```text
//!   .NAME.unfinished          the claim: a line with a random id, written before anything else; its lock tells whether someone writes
//!   .NAME.ID.unfinished       what is made, a file or a folder
//!   .NAME.ID.replaced         a folder that was there, for as long as the new one takes its place
//! ```
//!
//! A killed run leaves its claim, and with it the id: what has that id in its name is ours, and nothing else is. The next run takes the
//! claim over. Whatever else has the name of the claim is left alone, and told.

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

/// How often it is tried again when another program ends at the same moment, and removes its claim.
const TRIES: usize = 5;
/// What a claim begins with; the id follows, and the end of the line.
const MARK: &str = "corniche unfinished ";
/// Longer is no claim.
const MOST_BYTES: u64 = 100;
/// The ending of what is made.
const UNFINISHED: &str = "unfinished";
/// The ending of what was there.
const REPLACED: &str = "replaced";

/// What to do with what exists at a target.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Existing {
    /// It stays, and nothing is written.
    Keep,
    /// It is replaced.
    Replace,
}

/// The right to write at a target, for as long as this lives: a file beside it, which is locked.
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

/// The longest name that a file has beside its target while it is written.
pub(crate) fn longest_name(target: &Path) -> PathBuf {
    beside(target, &random_digits(), UNFINISHED)
}

impl Claim {
    /// Claims a target, which need not exist. What a killed run left beside it is neither used nor removed by that.
    ///
    /// # Errors
    /// Of kind `ResourceBusy` if another program writes there; else where the folder cannot be written, or something that is not ours has the
    /// name of the claim.
    pub fn take(target: &Path) -> io::Result<Self> {
        let name = target.file_name().unwrap_or_default().to_string_lossy();
        let path = target.with_file_name(format!(".{name}.{UNFINISHED}"));
        for _ in 0..TRIES {
            let file = open_own(&path, OpenMode::ChangeOrNew)?;
            lock(&file)?;
            if !is_at(&file, &path)? {
                continue;
            }
            // It becomes a claim, which is removed when it is dropped, only once it is known to be ours or to say nothing.
            let text = read(&file)?;
            let said = marked(&text, MARK);
            let id = match said {
                Marked::Id(id, "") => id.to_owned(),
                Marked::Begun => random_digits(),
                Marked::Id(..) | Marked::Other => {
                    return Err(in_the_way(&path, "it was not made by this version of Corniche"));
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

    /// What is claimed.
    #[must_use]
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// The file that is locked.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Where what becomes the target is made.
    #[must_use]
    pub fn unfinished(&self) -> PathBuf {
        self.beside(UNFINISHED)
    }

    /// Where what was at the target is put for as long as the new takes its place.
    #[must_use]
    pub fn replaced(&self) -> PathBuf {
        self.beside(REPLACED)
    }

    fn beside(&self, end: &str) -> PathBuf {
        beside(&self.target, &self.id, end)
    }

    /// Begins the file that becomes the target. What a killed run left of it is removed.
    ///
    /// # Errors
    /// Where the folder cannot be written.
    pub fn begin_file(self, existing: Existing) -> io::Result<UnfinishedFile> {
        let path = self.unfinished();
        remove_left(&path)?;
        let file = open_own(&path, OpenMode::New)?;
        let file = NamedTempFile::from_parts(file, TempPath::try_from_path(path)?);
        Ok(UnfinishedFile { file, existing, claim: self })
    }

    /// Begins the folder that becomes the target, or holds what does. What killed runs left of this target is removed.
    ///
    /// # Errors
    /// Where the folder cannot be written.
    pub fn begin_folder(self) -> io::Result<UnfinishedFolder> {
        let path = self.unfinished();
        for left in [&path, &self.replaced()] {
            remove_left(left)?;
        }
        // What is not finished is no concern of other users.
        create_private_folder(&path)?;
        Ok(UnfinishedFolder { path, claim: self })
    }

    /// Makes durable that this claim is there, so that what has its id is ours also after the machine failed.
    ///
    /// # Errors
    /// Where the disk fails.
    pub fn sync(&self) -> io::Result<()> {
        self.file.sync_all()?;
        sync_folder(folder_of(&self.path))
    }

    /// Writes the claim, in the place of one that was begun.
    fn sign(&mut self) -> io::Result<()> {
        self.file.set_len(0)?;
        self.file.rewind()?;
        self.file.write_all(format!("{MARK}{}\n", self.id).as_bytes())
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        // What is still there is known by the claim alone, and a later run removes both.
        let is_needed =
            [UNFINISHED, REPLACED].map(|end| self.beside(end)).iter().any(|path| is_there(path));
        if !is_needed && is_at(&self.file, &self.path).unwrap_or(false) {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// A file that is made beside its target. It is removed if it is dropped before it gets there.
#[derive(Debug)]
pub struct UnfinishedFile {
    // Dropped before what claims it.
    file: NamedTempFile,
    existing: Existing,
    claim: Claim,
}

impl UnfinishedFile {
    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.file.path()
    }

    /// Where it will be.
    #[must_use]
    pub fn target(&self) -> &Path {
        &self.claim.target
    }

    /// Moves the finished file to its target, durably; returns its size.
    ///
    /// # Errors
    /// Of kind `AlreadyExists` if there is something at the target that is to be kept; else when the disk does not take it.
    pub fn place(self) -> io::Result<u64> {
        // The claim is held until the file is in its place.
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

/// A folder that is made beside the target that it, or a file in it, becomes. It is removed when it is dropped; what cannot be removed is removed
/// by the next run with this target.
#[derive(Debug)]
pub struct UnfinishedFolder {
    path: PathBuf,
    claim: Claim,
}

impl UnfinishedFolder {
    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The claim of the target, which is held as long as the folder is in use.
    #[must_use]
    pub fn claim(&self) -> &Claim {
        &self.claim
    }

    /// Gives the folder the permissions of any new folder: for one that becomes the target itself. Until then it is this user's alone.
    ///
    /// # Errors
    /// Where the disk fails.
    pub fn open_to_others(&self) -> io::Result<()> {
        // What the process masks can be read only by setting it, for all threads.
        let any = self.path.join(".permissions");
        fs::create_dir(&any)?;
        let permissions = any.metadata()?.permissions();
        fs::remove_dir(&any)?;
        fs::set_permissions(&self.path, permissions)
    }

    /// Moves a finished file of the folder to the target, durably; returns its size.
    ///
    /// # Errors
    /// Those of [`UnfinishedFile::place`].
    pub fn place_file(self, name: &str, existing: Existing) -> io::Result<u64> {
        place(TempPath::try_from_path(self.path.join(name))?, &self.claim.target, existing)
    }
}

impl Drop for UnfinishedFolder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.path);
    }
}

/// What a file says that has the name of a claim.
fn read(file: &File) -> io::Result<String> {
    let mut bytes = Vec::new();
    file.take(MOST_BYTES).read_to_end(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Writes the bytes of a finished file to the disk, moves it to its target, and makes its name durable. Returns its size.
fn place(path: TempPath, target: &Path, existing: Existing) -> io::Result<u64> {
    let file = open_own(&path, OpenMode::Read)?;
    file.sync_all()?;
    let bytes = file.metadata()?.len();
    let placed = match existing {
        Existing::Replace => path.persist(target),
        // This fails where the other would replace what someone put there in the meantime.
        Existing::Keep => match path.persist_noclobber(target) {
            // Not every file system can do that. Without it only the check at the start protects an existing file.
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
        // Some network file systems have no locks. There the last one to finish wins.
        Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => Ok(()),
        Err(TryLockError::Error(error)) => Err(error),
    }
}

/// Removes what a killed run left under a name with the id of its claim.
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
