//! The location of a package: a file, or an address on a web server.

use std::{
    ffi::OsString,
    fmt,
    path::{Path, PathBuf},
};

use crate::{AddressError, HttpAddress};

/// The location of a package: a file, or an address on a web server.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PackagePlace {
    /// A file.
    File(PathBuf),
    /// An address.
    Address(HttpAddress),
}

impl PackagePlace {
    /// Parses an argument of the command line. A text that begins like `http://` is an address,
    /// even if a file has this name (the file is `./http://…`).
    ///
    /// # Errors
    /// [`AddressError`] for invalid or unsupported addresses.
    pub fn parse(word: OsString) -> Result<Self, AddressError> {
        let address = word.to_str().map(HttpAddress::parse).transpose()?.flatten();
        Ok(address.map_or_else(|| Self::File(word.into()), Self::Address))
    }

    /// The path of the file, or the address without secrets in place of a path.
    #[must_use]
    pub fn name(&self) -> &Path {
        match self {
            Self::File(path) => path,
            Self::Address(address) => Path::new(&address.shown),
        }
    }

    /// The file's name without its folder.
    #[must_use]
    pub fn file_name(&self) -> String {
        match self {
            Self::File(path) => path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            Self::Address(address) => address.file_name().to_owned(),
        }
    }
}

impl fmt::Display for PackagePlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.name().display().fmt(f)
    }
}
