//! Output files other than packages: a target never holds a truncated file.
//!
//! ```text
//!   claim ──► Output                a file that the command writes itself
//!         ──► named::NamedOutput    a file that a library writes by name
//!         ──► folder::FolderOutput  a folder
//! ```

pub(crate) mod folder;
mod leftovers;
pub(crate) mod named;
pub(crate) mod report_files;

use std::{
    fmt::Display,
    io::{self, BufWriter, Cursor, Write},
    path::{Path, PathBuf},
};

pub(crate) use corniche_store::Existing;
use corniche_store::{Claim, LackOfRoom, UnfinishedFile, file_target, is_same_file};
use image::RgbaImage;

use crate::{
    exit::ExitCode,
    failure::{CommandFailure, Result},
    interrupt, names,
};

/// The treatment of existing files, from `-O`.
pub(crate) fn existing_of(overwrite: bool) -> Existing {
    if overwrite { Existing::Replace } else { Existing::Keep }
}

/// Claims the target of a file while it is written.
pub(crate) fn claim(named: &Path, existing: Existing, others: &[&Path]) -> Result<Claim> {
    let target = writable(named)?;
    if others.iter().any(|other| is_same_file(other, &target)) {
        let reason = "the command already uses this file; choose another name";
        return Err(unusable(named, &reason));
    }
    if existing == Existing::Keep && named.symlink_metadata().is_ok() {
        return Err(exists(named));
    }
    let claim = Claim::take(&target).map_err(|error| not_begun(named, &error))?;
    interrupt::remove_at_end(claim.path());
    interrupt::remove_at_end(&claim.unfinished());
    Ok(claim)
}

/// The failure of a command whose target is unusable.
pub(crate) fn unusable(named: &Path, reason: &dyn Display) -> CommandFailure {
    unusable!("cannot write {named:?}: {reason}")
}

/// The failure to begin a file: a full disk is not the fault of the command line.
pub(crate) fn not_begun(named: &Path, error: &io::Error) -> CommandFailure {
    if LackOfRoom::from_io_error(error).is_some() {
        failed(named, error)
    } else {
        unusable(named, error)
    }
}

/// The failure to move a file to its target.
pub(crate) fn not_placed(target: &Path, error: &io::Error) -> CommandFailure {
    match error.kind() {
        io::ErrorKind::AlreadyExists => exists(target),
        _ => failed(target, error),
    }
}

/// A file that is written next to its target and moved there when it is complete.
#[derive(Debug)]
pub(crate) struct Output(BufWriter<UnfinishedFile>);

impl Output {
    /// Begins a file that must not be one of `others`, which the command itself reads or writes. An
    /// unwritable target is reported here, before any work is done.
    pub(crate) fn create(named: &Path, existing: Existing, others: &[&Path]) -> Result<Self> {
        let file = claim(named, existing, others)?.begin_file(existing);
        Ok(Self(BufWriter::new(file.map_err(|error| not_begun(named, &error))?)))
    }

    /// Moves the file to its target.
    pub(crate) fn finish(self) -> Result<()> {
        self.end()?.place()
    }

    /// Writes the whole file at once.
    pub(crate) fn write_whole(self, bytes: &[u8]) -> Result<()> {
        self.fill(bytes)?.place()
    }

    /// Writes the whole file; it is moved to its target later, together with others.
    pub(crate) fn fill(mut self, bytes: &[u8]) -> Result<Complete> {
        self.write_all(bytes).map_err(|error| failed(self.0.get_ref().target(), &error))?;
        self.end()
    }

    /// Ends the file; it is moved to its target later, together with others.
    pub(crate) fn end(self) -> Result<Complete> {
        self.0.into_inner().map(Complete).map_err(|refused| {
            let (error, writer) = refused.into_parts();
            failed(writer.get_ref().target(), &error)
        })
    }
}

/// A complete file, still next to its target.
#[derive(Debug)]
pub(crate) struct Complete(UnfinishedFile);

impl Complete {
    /// Moves it to its target.
    pub(crate) fn place(self) -> Result<()> {
        let target = self.0.target().to_path_buf();
        self.0.place().map_err(|error| not_placed(&target, &error))?;
        tracing::debug!(path = %target.display(), "file written");
        Ok(())
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

/// The path of a file for `target`: the target, or the file that a link there leads to. A target
/// that is neither free nor a regular file is rejected, also with `-O`: devices, pipes and folders
/// are never overwritten.
pub(crate) fn writable(target: &Path) -> Result<PathBuf> {
    names::refuse_what_is_no_file(target)?;
    file_target(target).map_err(|error| CommandFailure::new(ExitCode::Unusable, error))
}

/// The path of a package: like [`writable`], but its name must be that of a package, so that no
/// other file is overwritten by mistake.
pub(crate) fn writable_package(target: &Path) -> Result<PathBuf> {
    let place = writable(target)?;
    names::refuse_other_than_package(target)?;
    Ok(place)
}

/// Encodes an image as PNG.
pub(crate) fn png(picture: &RgbaImage) -> Result<Vec<u8>> {
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, image::ImageFormat::Png)?;
    Ok(bytes.into_inner())
}

pub(crate) fn failed(target: &Path, error: &io::Error) -> CommandFailure {
    let advice = LackOfRoom::advice(LackOfRoom::from_io_error(error));
    let cause = if advice.is_empty() { format!(": {error}") } else { format!(" ({error})") };
    CommandFailure::failed(format!("cannot write {target:?}{advice}{cause}"))
}

/// The failure of a command whose target exists.
pub(crate) fn exists(target: &Path) -> CommandFailure {
    CommandFailure::exists(format!("{target:?} already exists; pass -O to overwrite it"))
}

#[cfg(test)]
#[path = "output_tests.rs"]
mod tests;
