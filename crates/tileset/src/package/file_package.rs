//! A package that is read without `async`, from a file or from a source that threads wait for.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use corniche_geom::TileId;

use crate::{
    Manifest, Sections, TilePayload,
    package::{
        error::{OpenError, ReadError},
        reader::Package,
        source::{AnySource, BlockingSource, ByteSource as _, FileSource, SourceError},
        tool_record::ToolRecord,
    },
};

/// A package on disk, or from a source that threads can wait for: the same as [`Package`], without
/// `async`.
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
    /// Same as [`Package::open`], with the name of the file.
    pub fn open(path: &Path) -> Result<Self, OpenError> {
        let source = FileSource::open(path).map_err(|error| named(path, error.into()))?;
        let file_name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Self::of_source(path, file_name, Arc::new(source))
    }

    /// Opens a package from `source`. `name` takes the place of the file's path (for example an
    /// address); `file_name` is the name that the file would have.
    ///
    /// # Errors
    /// Same as [`Package::open`], with this name.
    pub fn of_source(
        name: &Path,
        file_name: String,
        source: Arc<dyn BlockingSource>,
    ) -> Result<Self, OpenError> {
        let opened = pollster::block_on(Package::open(AnySource::new(source)));
        let package = opened.map_err(|error| named(name, error))?;
        Ok(Self { package, path: name.to_path_buf(), file_name })
    }

    /// Returns the underlying package, whose methods are `async`.
    #[must_use]
    pub fn into_package(self) -> Package<AnySource> {
        self.package
    }

    /// See [`Package::with_datum`].
    #[must_use]
    pub fn with_datum(self, datum: String, dem_vertical_crs: &str) -> Self {
        Self { package: self.package.with_datum(datum, dem_vertical_crs), ..self }
    }

    /// The path of the file, or the address in its place.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The name of the file, without its folder. For an address it is the last part of the path, so
    /// that files written from a package do not depend on its location.
    #[must_use]
    pub fn file_name(&self) -> &str {
        &self.file_name
    }

    /// Returns the number of bytes of the package.
    ///
    /// # Errors
    /// When the number cannot be determined.
    pub fn bytes(&self) -> Result<u64, OpenError> {
        let length = pollster::block_on(self.package.source().length());
        length.map_err(|error| named(&self.path, error.into()))
    }

    /// The first read of the package's bytes that failed, if any. Callers that treat unreadable
    /// tiles as damaged use it to distinguish the two.
    #[must_use]
    pub fn failed_read(&self) -> Option<&SourceError> {
        self.package.source().failure()
    }

    /// The manifest.
    #[must_use]
    pub fn manifest(&self) -> &Manifest {
        self.package.manifest()
    }

    /// See [`Package::tool_record`].
    ///
    /// # Errors
    /// Same as [`Package::tool_record`], with the name of the file.
    pub fn tool_record(&self) -> Result<ToolRecord, OpenError> {
        pollster::block_on(self.package.tool_record()).map_err(|error| named(&self.path, error))
    }

    /// See [`Package::tile_ids`].
    ///
    /// # Errors
    /// Same as [`Package::tile_ids`], with the name of the file.
    pub fn tile_ids(&self) -> Result<Vec<TileId>, OpenError> {
        pollster::block_on(self.package.tile_ids()).map_err(|error| named(&self.path, error))
    }

    /// See [`Package::tile`].
    ///
    /// # Errors
    /// Same as [`Package::tile`].
    pub fn tile(&self, id: TileId) -> Result<Option<Vec<u8>>, ReadError> {
        pollster::block_on(self.package.tile(id))
    }

    /// See [`Package::payload`].
    ///
    /// # Errors
    /// Same as [`Package::payload`].
    pub fn payload(&self, id: TileId, wanted: Sections) -> Result<Option<TilePayload>, ReadError> {
        pollster::block_on(self.package.payload(id, wanted))
    }
}

fn named(path: &Path, error: OpenError) -> OpenError {
    OpenError::File { path: path.to_path_buf(), source: Box::new(error) }
}
