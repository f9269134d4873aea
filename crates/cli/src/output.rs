//! Files beside the package that commands write: a file that is cut off never stands at its target.

use std::{
    fmt::Display,
    io::{self, BufWriter, Cursor, Write},
    path::{Path, PathBuf},
};

pub(crate) use corniche_pipeline::Existing;
use corniche_pipeline::{Claim, file_target, folder_of};
use image::RgbaImage;
use tempfile::{NamedTempFile, TempPath};

use crate::{exit::ExitCode, failure::Failure, interrupt, names};

/// What to do with a file that exists, as `-O` says.
pub(crate) fn existing_of(overwrite: bool) -> Existing {
    if overwrite { Existing::Replace } else { Existing::Keep }
}

/// A place for a file, claimed while it is written.
pub(crate) fn claim(
    named: &Path,
    existing: Existing,
    others: &[&Path],
) -> Result<(PathBuf, Claim), Failure> {
    let unusable = |reason: &dyn Display| {
        Failure::unusable(format!("cannot write {}: {reason}", named.display()))
    };
    let target = writable(named)?;
    if others.iter().any(|other| is_same_file(other, &target)) {
        return Err(unusable(&"the command uses that file itself; choose another name"));
    }
    if existing == Existing::Keep && named.symlink_metadata().is_ok() {
        return Err(exists(named));
    }
    let claim = Claim::take(&target).map_err(|error| not_begun(named, &error))?;
    interrupt::remove_at_end(claim.path());
    interrupt::remove_at_end(&claim.unfinished());
    Ok((target, claim))
}

/// Why something cannot be begun: a disk that is full is no fault of what was asked for.
pub(crate) fn not_begun(named: &Path, error: &io::Error) -> Failure {
    use io::ErrorKind::{FileTooLarge, QuotaExceeded, StorageFull};
    match error.kind() {
        FileTooLarge | QuotaExceeded | StorageFull => failed(named, error),
        _ => Failure::unusable(format!("cannot write {}: {error}", named.display())),
    }
}

/// Puts a finished file in its place, durably; returns its size in bytes.
pub(crate) fn place(path: TempPath, target: &Path, existing: Existing) -> Result<u64, Failure> {
    let placed = corniche_pipeline::place_finished(path, target, existing);
    placed.map_err(|error| match error.kind() {
        io::ErrorKind::AlreadyExists => exists(target),
        _ => failed(target, &error),
    })
}

/// A file that is written beside its target and takes its place when it is complete.
#[derive(Debug)]
pub(crate) struct Output {
    target: PathBuf,
    existing: Existing,
    file: BufWriter<NamedTempFile>,
    /// Dropped last.
    claim: Claim,
}

impl Output {
    /// Begins a file that is none of `others`, which the command reads or writes itself. An unusable place is reported here,
    /// before any work is done.
    pub(crate) fn create(
        target: &Path,
        existing: Existing,
        others: &[&Path],
    ) -> Result<Self, Failure> {
        let named = target;
        let (target, claim) = claim(named, existing, others)?;
        let file = claim.begin_file().map_err(|error| not_begun(named, &error))?;
        Ok(Self { target, existing, file: BufWriter::new(file), claim })
    }

    /// Puts the file in its place.
    pub(crate) fn finish(self) -> Result<(), Failure> {
        self.end()?.place()
    }

    /// Writes the whole file at once.
    pub(crate) fn write_whole(self, bytes: &[u8]) -> Result<(), Failure> {
        self.fill(bytes)?.place()
    }

    /// Writes the whole file, which takes its place later: together with others.
    pub(crate) fn fill(mut self, bytes: &[u8]) -> Result<Complete, Failure> {
        self.file.write_all(bytes).map_err(|error| failed(&self.target, &error))?;
        self.end()
    }

    fn end(self) -> Result<Complete, Failure> {
        let Self { target, existing, file, claim } = self;
        let file = file
            .into_inner()
            .map_err(|error| failed(&target, &io::IntoInnerError::into_error(error)))?;
        Ok(Complete { target, existing, file, claim })
    }
}

/// A file that is written to its end, beside its target.
#[derive(Debug)]
pub(crate) struct Complete {
    target: PathBuf,
    existing: Existing,
    file: NamedTempFile,
    /// Dropped last.
    claim: Claim,
}

impl Complete {
    /// Puts it in its place.
    pub(crate) fn place(self) -> Result<(), Failure> {
        // The claim is held until the file is in its place.
        let Self { target, existing, file, claim: _claim } = self;
        place(file.into_temp_path(), &target, existing)?;
        tracing::debug!(path = %target.display(), "file written");
        Ok(())
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// Where a file that is wanted at `target` goes: there, or to the file that a link there leads to. A place that is neither
/// free nor a regular file's is refused, with `-O` too: devices, pipes and folders are never replaced.
pub(crate) fn writable(target: &Path) -> Result<PathBuf, Failure> {
    names::refuse_what_is_no_file(target)?;
    file_target(target).map_err(|error| Failure::new(ExitCode::Unusable, error))
}

/// Where a package goes: like [`writable`], and its name says what it is, so that no other file is meant.
pub(crate) fn writable_package(target: &Path) -> Result<PathBuf, Failure> {
    let place = writable(target)?;
    names::refuse_other_than_package(target)?;
    Ok(place)
}

/// Whether two paths lead to one file, which need not exist yet.
pub(crate) fn is_same_file(one: &Path, other: &Path) -> bool {
    place_of(one) == place_of(other)
}

/// Where a file is or will be, whatever way its path is written: for one that does not exist yet, its folder's place.
fn place_of(path: &Path) -> PathBuf {
    if let Ok(place) = path.canonicalize() {
        return place;
    }
    match (folder_of(path).canonicalize(), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path.to_path_buf(),
    }
}

/// A picture's file.
pub(crate) fn png(picture: &RgbaImage) -> Result<Vec<u8>, Failure> {
    let mut bytes = Cursor::new(Vec::new());
    picture
        .write_to(&mut bytes, image::ImageFormat::Png)
        .map_err(|error| Failure::new(ExitCode::Failed, error))?;
    Ok(bytes.into_inner())
}

pub(crate) fn failed(target: &Path, error: &io::Error) -> Failure {
    Failure::new(
        ExitCode::Failed,
        anyhow::anyhow!("cannot write {} (disk full?): {error}", target.display()),
    )
}

/// The failure of a command whose target exists.
pub(crate) fn exists(target: &Path) -> Failure {
    Failure::exists(format!("{} exists already; give -O to replace it", target.display()))
}

#[cfg(test)]
#[path = "output_tests.rs"]
mod tests;
