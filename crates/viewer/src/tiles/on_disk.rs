//! The tiles of a package for threads that may wait, from a file or a similar source.

use std::{path::Path, sync::Arc};

use corniche_geom::{GridFrame, TileId};
use corniche_styles::Style;
use corniche_tileset::{AnySource, FilePackage, Manifest, OpenError};

use super::{
    LoadTileError, MapPackage, Overlays, PackageTiles, TileCatalog, TileGeometry, TileSource,
};
use crate::{
    lod::GroundSummary,
    options::{Mapping, RoadMethod},
};

/// A package in a file, or elsewhere where threads can wait for its tiles.
#[derive(Debug)]
pub struct PackageSource(PackageTiles<AnySource>);

impl PackageSource {
    /// Opens a file and lists its tiles.
    ///
    /// # Errors
    /// When it cannot be read or is no package of this version.
    pub fn open(path: &Path) -> Result<Self, OpenError> {
        Self::new(FilePackage::open(path)?)
    }

    /// Lists the tiles of a package that is open.
    ///
    /// # Errors
    /// When its directories cannot be read or are damaged.
    pub fn new(package: FilePackage) -> Result<Self, OpenError> {
        let path = package.path().to_path_buf();
        let tiles = pollster::block_on(PackageTiles::new(package.into_package()));
        tiles.map(Self).map_err(|source| OpenError::File { path, source: Box::new(source) })
    }

    /// See [`PackageTiles::for_method`].
    #[must_use]
    pub fn for_method(self, method: RoadMethod) -> Self {
        Self(self.0.for_method(method))
    }
}

impl PackageSource {
    /// See [`TileDecoder::for_look`](super::TileDecoder::for_look).
    #[must_use]
    pub fn for_look(self, method: RoadMethod, style: &Style) -> Self {
        Self(self.0.for_look(method, style))
    }
}

impl PackageSource {
    /// See [`TileDecoder::with_mapping`](super::TileDecoder::with_mapping).
    #[must_use]
    pub fn with_mapping(self, mapping: Mapping) -> Self {
        Self(self.0.with_mapping(mapping))
    }

    /// See [`PackageTiles::with_overlays`].
    #[must_use]
    pub fn with_overlays(self, overlays: Arc<Overlays>) -> Self {
        Self(self.0.with_overlays(overlays))
    }
}

impl TileCatalog for PackageSource {
    fn frame(&self) -> &GridFrame {
        self.0.frame()
    }

    fn exists(&self, id: TileId) -> bool {
        self.0.exists(id)
    }
}

impl TileSource for PackageSource {
    fn load(&self, id: TileId) -> Result<TileGeometry, LoadTileError> {
        pollster::block_on(self.0.load(id))
    }

    fn summary(&self, id: TileId) -> Result<Option<GroundSummary>, LoadTileError> {
        pollster::block_on(self.0.summary(id))
    }

    fn load_slopes(&self, id: TileId) -> Result<TileGeometry, LoadTileError> {
        pollster::block_on(self.0.load_slopes(id))
    }

    fn may_have_roads(&self) -> bool {
        self.0.may_have_roads()
    }
}

impl MapPackage for PackageSource {
    fn manifest(&self) -> &Manifest {
        self.0.manifest()
    }
}
