//! The tiles of a package for threads that may wait, from a file or a similar source.

use std::path::Path;

use corniche_geom::TileId;
use corniche_tileset::{AnySource, FilePackage, OpenError};

use super::{LoadTileError, PackageTiles, TileGeometry, TileSource};
use crate::lod::GroundSummary;

/// A package in a file or in another source for which threads can wait.
pub type PackageSource = PackageTiles<AnySource>;

impl PackageSource {
    /// Opens a file and lists its tiles.
    ///
    /// # Errors
    /// When it cannot be read or is no package of this version.
    pub fn open(path: &Path) -> Result<Self, OpenError> {
        Self::of_file(FilePackage::open(path)?)
    }

    /// Lists the tiles of an open package.
    ///
    /// # Errors
    /// When its directories cannot be read or are damaged.
    pub fn of_file(package: FilePackage) -> Result<Self, OpenError> {
        let path = package.path().to_path_buf();
        let tiles = pollster::block_on(PackageTiles::new(package.into_package()));
        tiles.map_err(|source| OpenError::File { path, source: Box::new(source) })
    }
}

impl TileSource for PackageSource {
    fn load(&self, id: TileId) -> Result<TileGeometry, LoadTileError> {
        pollster::block_on(self.tile(id))
    }

    fn summary(&self, id: TileId) -> Result<Option<GroundSummary>, LoadTileError> {
        pollster::block_on(self.summary_of(id))
    }

    fn load_slopes(&self, id: TileId) -> Result<TileGeometry, LoadTileError> {
        pollster::block_on(self.slopes_of(id))
    }

    fn may_have_roads(&self) -> bool {
        PackageTiles::may_have_roads(self)
    }
}
