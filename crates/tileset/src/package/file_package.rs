//! A package that is read without `async`, from a file or from a source that threads wait for.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use corniche_geom::TileId;

use crate::package::error::{OpenError, ReadError};
use crate::package::reader::Package;
use crate::package::source::{AnySource, BlockingSource, ByteSource as _, FileSource, SourceError};
use crate::package::tool_record::ToolRecord;
use crate::{Manifest, Sections, TilePayload};

/// A package on disk, or elsewhere where threads can wait for its bytes: the same as [`Package`] without `async`.
#[derive(Debug)]
pub struct FilePackage {
    package: Package<AnySource>,
    path: PathBuf,
    file_name: String,
}

impl FilePackage {
    /// Opens a file.
    ///
    /// # Errors
    /// As [`Package::open`], with the name of the file.
    pub fn open(path: &Path) -> Result<Self, OpenError> {
        let source = FileSource::open(path).map_err(|error| named(path, error.into()))?;
        let file_name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Self::of_source(path, file_name, Arc::new(source))
    }

    /// Opens what `source` gives. `name` stands for the path of a file: an address, say; `file_name` is what the file would be called.
    ///
    /// # Errors
    /// As [`Package::open`], with this name.
    pub fn of_source(
        name: &Path,
        file_name: String,
        source: Arc<dyn BlockingSource>,
    ) -> Result<Self, OpenError> {
        let opened = pollster::block_on(Package::open(AnySource::new(source)));
        let package = opened.map_err(|error| named(name, error))?;
        Ok(Self { package, path: name.to_path_buf(), file_name })
    }

    /// The package itself, whose methods are `async`.
    #[must_use]
    pub fn into_package(self) -> Package<AnySource> {
        self.package
    }

    /// See [`Package::with_datum`].
    #[must_use]
    pub fn with_datum(self, datum: String, dem_vertical_crs: &str) -> Self {
        Self { package: self.package.with_datum(datum, dem_vertical_crs), ..self }
    }

    /// The file, or the address in its place.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The name of the file, without its folder. At an address it is the last part of the path, so what is written of a package does not depend on where
    /// it is.
    #[must_use]
    pub fn file_name(&self) -> &str {
        &self.file_name
    }

    /// How many bytes the package has.
    ///
    /// # Errors
    /// When that cannot be found out.
    pub fn bytes(&self) -> Result<u64, OpenError> {
        let length = pollster::block_on(self.package.source().length());
        length.map_err(|error| named(&self.path, error.into()))
    }

    /// The first read of its bytes that failed, if one has. Those who take a tile that cannot be read for a damaged one ask for it.
    #[must_use]
    pub fn failed_read(&self) -> Option<&SourceError> {
        self.package.source().failure()
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
        pollster::block_on(self.package.tool_record()).map_err(|error| named(&self.path, error))
    }

    /// See [`Package::tile_ids`].
    ///
    /// # Errors
    /// As [`Package::tile_ids`], with the name of the file.
    pub fn tile_ids(&self) -> Result<Vec<TileId>, OpenError> {
        pollster::block_on(self.package.tile_ids()).map_err(|error| named(&self.path, error))
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

fn named(path: &Path, error: OpenError) -> OpenError {
    OpenError::File { path: path.to_path_buf(), source: Box::new(error) }
}
