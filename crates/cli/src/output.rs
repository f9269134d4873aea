//! Files beside the package that commands write: a file that is cut off never stands at its target.
//!
//! ```text
//!   claim ──► Output                a file that the command writes itself
//!         ──► named::NamedOutput    a file that a library writes by its name
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

use crate::{exit::ExitCode, failure::Failure, interrupt, names};

/// What to do with a file that exists, as `-O` says.
pub(crate) fn existing_of(overwrite: bool) -> Existing {
    if overwrite { Existing::Replace } else { Existing::Keep }
}

/// A place for a file, claimed while it is written.
pub(crate) fn claim(named: &Path, existing: Existing, others: &[&Path]) -> Result<Claim, Failure> {
    let target = writable(named)?;
    if others.iter().any(|other| is_same_file(other, &target)) {
        let reason = "the command uses that file itself; choose another name";
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

/// The failure of a command whose target is of no use.
pub(crate) fn unusable(named: &Path, reason: &dyn Display) -> Failure {
    Failure::unusable(format!("cannot write {}: {reason}", named.display()))
}

/// Why something cannot be begun: a disk that is full is no fault of what was asked for.
pub(crate) fn not_begun(named: &Path, error: &io::Error) -> Failure {
    if LackOfRoom::of(error).is_some() { failed(named, error) } else { unusable(named, error) }
}

/// Why something did not get to its place.
pub(crate) fn not_placed(target: &Path, error: &io::Error) -> Failure {
    match error.kind() {
        io::ErrorKind::AlreadyExists => exists(target),
        _ => failed(target, error),
    }
}

/// A file that is written beside its target and takes its place when it is complete.
#[derive(Debug)]
pub(crate) struct Output(BufWriter<UnfinishedFile>);

impl Output {
    /// Begins a file that is none of `others`, which the command reads or writes itself. An unusable place is reported here,
    /// before any work is done.
    pub(crate) fn create(
        named: &Path,
        existing: Existing,
        others: &[&Path],
    ) -> Result<Self, Failure> {
        let file = claim(named, existing, others)?.begin_file(existing);
        Ok(Self(BufWriter::new(file.map_err(|error| not_begun(named, &error))?)))
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
        self.write_all(bytes).map_err(|error| failed(self.0.get_ref().target(), &error))?;
        self.end()
    }

    /// Ends the file, which takes its place later: together with others.
    pub(crate) fn end(self) -> Result<Complete, Failure> {
        self.0.into_inner().map(Complete).map_err(|refused| {
            let (error, writer) = refused.into_parts();
            failed(writer.get_ref().target(), &error)
        })
    }
}

/// A file that is written to its end, beside its target.
#[derive(Debug)]
pub(crate) struct Complete(UnfinishedFile);

impl Complete {
    /// Puts it in its place.
    pub(crate) fn place(self) -> Result<(), Failure> {
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

/// A picture's file.
pub(crate) fn png(picture: &RgbaImage) -> Result<Vec<u8>, Failure> {
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, image::ImageFormat::Png)?;
    Ok(bytes.into_inner())
}

pub(crate) fn failed(target: &Path, error: &io::Error) -> Failure {
    let advice = LackOfRoom::advice(LackOfRoom::of(error));
    Failure::failed(format!("cannot write {}{advice}: {error}", target.display()))
}

/// The failure of a command whose target exists.
pub(crate) fn exists(target: &Path) -> Failure {
    Failure::exists(format!("{} exists already; give -O to replace it", target.display()))
}

#[cfg(test)]
#[path = "output_tests.rs"]
mod tests;
