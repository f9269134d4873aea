//! The page of the viewer: files that are built into the program, or lie in a folder.

use std::{borrow::Cow, fs, path::Path};

use super::page_files::page_files;
use crate::{exit::ExitCode, failure::Failure, table::bytes};

/// What the program was built with: paths in addresses, and bytes. The build script writes it.
const BUILT_IN: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/page.rs"));

/// More than any page takes in memory.
const MOST_BYTES: u64 = 512 << 20;

/// A file of the page.
#[derive(Debug)]
pub(crate) struct PageFile {
    /// Its path in addresses, such as `examples/fly.html`.
    pub(crate) path: String,
    pub(crate) bytes: Cow<'static, [u8]>,
}

/// The files of the page: those of a folder, or else those of the program.
pub(crate) fn load(folder: Option<&Path>) -> Result<Vec<PageFile>, Failure> {
    folder.map_or_else(|| Ok(built_in()), read)
}

fn built_in() -> Vec<PageFile> {
    let file = |&(path, bytes): &(&str, &'static [u8])| PageFile {
        path: path.to_owned(),
        bytes: Cow::Borrowed(bytes),
    };
    BUILT_IN.iter().map(file).collect()
}

/// They are read once, so that all are of one version, and what is put into the folder later is not served.
fn read(folder: &Path) -> Result<Vec<PageFile>, Failure> {
    let unusable = |reason: &dyn std::fmt::Display| {
        Failure::unusable(format!(
            "--page {}: {reason}; give the folder that scripts/web makes, target/web/site",
            folder.display()
        ))
    };
    let files = page_files(folder).map_err(|error| unusable(&error))?;
    let mut read_bytes = 0;
    let read = files.into_iter().map(|(path, place)| {
        let failed = |error| Failure::new(ExitCode::Unusable, error).about(&place);
        read_bytes += fs::metadata(&place).map_err(failed)?.len();
        if read_bytes > MOST_BYTES {
            return Err(unusable(&format_args!("it holds more than {}", bytes(MOST_BYTES))));
        }
        Ok(PageFile { path, bytes: fs::read(&place).map_err(failed)?.into() })
    });
    read.collect()
}

#[cfg(test)]
#[path = "page_tests.rs"]
mod tests;
