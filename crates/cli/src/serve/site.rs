//! The files of a page with its packages, in a folder for any web server.

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
    failure::Failure,
    interrupt, names,
    output::{Existing, failed, folder::FolderOutput},
};

/// Bytes that are copied between two looks at whether to stop.
const COPIED_AT_ONCE: u64 = 64 << 20;

/// Writes a folder, which is there when it is complete. `used` are files of the command. Returns the size of the folder in bytes.
pub(crate) fn write(
    target: &Path,
    existing: Existing,
    page: &[PageFile],
    packages: &[Shown],
    used: &[&Path],
) -> Result<u64, Failure> {
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

/// Copies a package; `target` is what the folder is called.
fn copy(file: &Path, place: &Path, target: &Path) -> Result<(), Failure> {
    let unread = |error: io::Error| Failure::from(error).about(file);
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
            return Err(Failure::interrupted());
        }
        let part = io::copy(&mut (&from).take(COPIED_AT_ONCE), &mut to);
        // Which of the two files it was is not told.
        let bytes = part.map_err(|error| failed(target, &error))?;
        if bytes == 0 {
            break;
        }
        copied += bytes;
    }
    let after = version(&from).map_err(unread)?;
    if before != after || copied != before.0 {
        return Err(Failure::failed(format!(
            "{} changed while it was copied; run the command again",
            file.display()
        )));
    }
    Ok(())
}
