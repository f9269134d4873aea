//! Writes the files of a page and its packages to a folder for any web server.

use std::{
    fs::{self, File},
    io::{self, Read as _},
    path::Path,
};

use super::{
    page::PageFile,
    shown::{LIST, Shown, list},
};
use crate::{
    failure::{CommandFailure, Result},
    interrupt, names,
    output::{Existing, failed, folder::FolderOutput},
};

/// The number of bytes that are copied between two checks whether to stop.
const COPIED_AT_ONCE: u64 = 64 << 20;

/// Writes a folder, which appears when it is complete. `used` are files of the command. Returns the
/// size of the folder in bytes.
pub(crate) fn write(
    target: &Path,
    existing: Existing,
    page: &[PageFile],
    packages: &[Shown],
    used: &[&Path],
) -> Result<u64> {
    names::refuse_what_is_no_file(target)?;
    let output = FolderOutput::create(target, existing, used)?;
    let not_written = |error: io::Error| failed(target, &error);
    for file in page {
        let place = output.path().join(&file.path);
        fs::create_dir_all(place.parent().unwrap_or(output.path())).map_err(not_written)?;
        fs::write(place, &file.bytes).map_err(not_written)?;
    }
    fs::write(output.path().join(LIST), list(packages)).map_err(not_written)?;
    fs::create_dir_all(output.path().join("packages")).map_err(not_written)?;
    for package in packages {
        copy(&package.file, &output.path().join(package.path()), target)?;
    }
    output.place("web page of packages")
}

/// Copies a package; `target` is the name of the folder.
fn copy(file: &Path, place: &Path, target: &Path) -> Result<()> {
    let unread = |error: io::Error| CommandFailure::from(error).about(file);
    let from = File::open(file).map_err(unread)?;
    let version = |from: &File| {
        let found = from.metadata()?;
        Ok((found.len(), found.modified()?))
    };
    let before = version(&from).map_err(unread)?;
    let mut to = File::create_new(place).map_err(|error| failed(target, &error))?;
    let mut copied = 0;
    loop {
        if interrupt::is_noted() {
            return Err(CommandFailure::interrupted());
        }
        let part = io::copy(&mut (&from).take(COPIED_AT_ONCE), &mut to);
        // The error does not say which of the two files failed.
        let bytes = part.map_err(|error| failed(target, &error))?;
        if bytes == 0 {
            break;
        }
        copied += bytes;
    }
    let after = version(&from).map_err(unread)?;
    if before != after || copied != before.0 {
        return Err(CommandFailure::failed(format!(
            "{file:?} changed while it was being copied; run the command again"
        )));
    }
    Ok(())
}
