//! The page of the viewer: files that are built into the program, or that are in a folder.

use std::{borrow::Cow, fs, path::Path};

use super::page_files::page_files;
use crate::{
    exit::ExitCode,
    failure::{CommandFailure, Result},
    table::bytes,
};

/// The built-in files: URL paths and bytes. The build script writes this list.
const BUILT_IN: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/page.rs"));

/// The largest memory that a page may need.
const MOST_BYTES: u64 = 512 << 20;

/// A file of the page.
#[derive(Debug)]
pub(crate) struct PageFile {
    /// Its URL path, such as `examples/fly.html`.
    pub path: String,
    pub bytes: Cow<'static, [u8]>,
}

/// Loads the files of the page: those of a folder, or the built-in ones.
pub(crate) fn load(folder: Option<&Path>) -> Result<Vec<PageFile>> {
    folder.map_or_else(|| Ok(built_in()), read)
}

fn built_in() -> Vec<PageFile> {
    let file = |&(path, bytes): &(&str, &'static [u8])| PageFile {
        path: path.to_owned(),
        bytes: Cow::Borrowed(bytes),
    };
    BUILT_IN.iter().map(file).collect()
}

/// Reads all files once, so that they are of one version, and files that are added to the folder
/// later are not served.
fn read(folder: &Path) -> Result<Vec<PageFile>> {
    let unusable = |reason: &dyn std::fmt::Display| {
        unusable!(
            "--page {folder:?}: {reason}; pass the folder that scripts/web creates, target/web/site"
        )
    };
    let files = page_files(folder).map_err(|error| unusable(&error))?;
    let mut read_bytes = 0;
    let read = files.into_iter().map(|(path, place)| {
        let failed = |error| CommandFailure::new(ExitCode::Unusable, error).about(&place);
        read_bytes += fs::metadata(&place).map_err(failed)?.len();
        if read_bytes > MOST_BYTES {
            return Err(unusable(&format_args!("the folder has more than {}", bytes(MOST_BYTES))));
        }
        Ok(PageFile { path, bytes: fs::read(&place).map_err(failed)?.into() })
    });
    read.collect()
}

#[cfg(test)]
#[path = "page_tests.rs"]
mod tests;
