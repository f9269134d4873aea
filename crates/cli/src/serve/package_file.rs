//! A package on disk, for the server: the file that was named, even if a link later leads
//! elsewhere.

use std::{
    fs::{self, File},
    io::{self, Read as _, Seek as _},
    ops::Range,
    path::{Path, PathBuf},
};

use corniche_serve::OnDisk;
use corniche_store::{OpenMode, open_own};
use corniche_tileset::telling_ranges;

/// The number of bytes at the start of a package that identify its version.
const START_BYTES: u64 = 1024;

/// The file of a package.
#[derive(Debug)]
pub(crate) struct PackageFile(PathBuf);

impl PackageFile {
    /// The file that a path leads to now. Later changes of links are not followed.
    pub(crate) fn at_path(path: &Path) -> io::Result<Self> {
        fs::canonicalize(path).map(Self)
    }
}

impl OnDisk for PackageFile {
    fn open(&self) -> io::Result<File> {
        // The error contains the path, which clients must not see.
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
        // A file that is no longer a package must not be served.
        Ok(ranges.ok_or(io::ErrorKind::NotFound)?.into())
    }
}
