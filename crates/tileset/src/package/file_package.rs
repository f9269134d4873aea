use std::path::{Path, PathBuf};

use corniche_geom::TileId;

use crate::package::error::{OpenError, ReadError};
use crate::package::reader::Package;
use crate::package::source::FileSource;
use crate::package::tool_record::ToolRecord;
use crate::{Manifest, Sections, TilePayload};

/// A package on disk, for callers that wait: the same as [`Package`] without `async`.
#[derive(Debug)]
pub struct FilePackage {
    package: Package<FileSource>,
    path: PathBuf,
}

impl FilePackage {
    /// Opens a file.
    ///
    /// # Errors
    /// As [`Package::open`], with the name of the file.
    pub fn open(path: &Path) -> Result<Self, OpenError> {
        let named = |source| OpenError::File { path: path.to_path_buf(), source: Box::new(source) };
        let source = FileSource::open(path).map_err(|error| named(error.into()))?;
        let package = pollster::block_on(Package::open(source)).map_err(named)?;
        Ok(Self { package, path: path.to_path_buf() })
    }

    /// The package itself, whose methods are `async`.
    #[must_use]
    pub fn into_package(self) -> Package<FileSource> {
        self.package
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The table of contents.
    #[must_use]
    pub fn manifest(&self) -> &Manifest {
        self.package.manifest()
    }

    /// See [`Package::tool_record`].
    ///
    /// # Errors
    /// As [`Package::tool_record`], with the name of the file.
    pub fn tool_record(&self) -> Result<ToolRecord, OpenError> {
        pollster::block_on(self.package.tool_record())
            .map_err(|source| OpenError::File { path: self.path.clone(), source: Box::new(source) })
    }

    /// See [`Package::tile_ids`].
    ///
    /// # Errors
    /// As [`Package::tile_ids`], with the name of the file.
    pub fn tile_ids(&self) -> Result<Vec<TileId>, OpenError> {
        pollster::block_on(self.package.tile_ids())
            .map_err(|source| OpenError::File { path: self.path.clone(), source: Box::new(source) })
    }

    /// See [`Package::tile`].
    ///
    /// # Errors
    /// As [`Package::tile`].
    pub fn tile(&self, id: TileId) -> Result<Option<Vec<u8>>, ReadError> {
        pollster::block_on(self.package.tile(id))
    }

    /// See [`Package::payload`].
    ///
    /// # Errors
    /// As [`Package::payload`].
    pub fn payload(&self, id: TileId, wanted: Sections) -> Result<Option<TilePayload>, ReadError> {
        pollster::block_on(self.package.payload(id, wanted))
    }
}
