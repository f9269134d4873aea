//! A package on disk, for the server: the file that was named, and no other that takes its place by a link.

use std::{
    fs::{self, File},
    io::{self, Read as _, Seek as _},
    ops::Range,
    path::{Path, PathBuf},
};

use corniche_serve::OnDisk;
use corniche_store::{OpenMode, open_own};
use corniche_tileset::telling_ranges;

/// So much of a package is read to see which it is.
const START_BYTES: u64 = 1024;

/// The file of a package.
#[derive(Debug)]
pub(crate) struct PackageFile(PathBuf);

impl PackageFile {
    /// The file that a path leads to now. Where a link leads later is not followed.
    pub(crate) fn of(path: &Path) -> io::Result<Self> {
        fs::canonicalize(path).map(Self)
    }
}

impl OnDisk for PackageFile {
    fn open(&self) -> io::Result<File> {
        // Its path is for nobody who asks, and stands in the error.
        open_own(&self.0, OpenMode::Read).map_err(|error| match error.kind() {
            io::ErrorKind::InvalidInput => io::ErrorKind::NotFound.into(),
            _ => error,
        })
    }

    fn telling(&self, mut file: &File) -> io::Result<Vec<Range<u64>>> {
        let mut start = Vec::new();
        file.rewind()?;
        file.take(START_BYTES).read_to_end(&mut start)?;
        let ranges = telling_ranges(&start, file.metadata()?.len());
        // What is no package is none that was to be shown.
        Ok(ranges.ok_or(io::ErrorKind::NotFound)?.into())
    }
}
