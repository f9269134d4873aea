//! Where a package is: in a file or at an address on a web server.

use std::{
    ffi::OsString,
    fmt,
    path::{Path, PathBuf},
};

use crate::{AddressError, HttpAddress};

/// Where a package is: a file, or an address on a web server.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PackagePlace {
    /// A file.
    File(PathBuf),
    /// An address.
    Address(HttpAddress),
}

impl PackagePlace {
    /// The place that a word of the command line names. What begins like `http://` is an address, whether a file is called so or not
    /// (`./http://…` is the file).
    ///
    /// # Errors
    /// [`AddressError`] for addresses that cannot be read.
    pub fn parse(word: OsString) -> Result<Self, AddressError> {
        let address = word.to_str().map(HttpAddress::parse).transpose()?.flatten();
        Ok(address.map_or_else(|| Self::File(word.into()), Self::Address))
    }

    /// The path of the file, or what stands for it: the address without secrets.
    #[must_use]
    pub fn name(&self) -> &Path {
        match self {
            Self::File(path) => path,
            Self::Address(address) => Path::new(address.shown()),
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
