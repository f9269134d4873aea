//! Loads the tiles of a package from any source of bytes, without blocking a thread.

use std::collections::BTreeSet;

use corniche_geom::{GridFrame, TileId};
use corniche_tileset::{ByteSource, Manifest, OpenError, Package, Sections, terrain_summary};

use super::{LoadTileError, MapPackage, ShadingSlopes, TileCatalog, TileDecoder, TileGeometry};
use crate::lod::GroundSummary;

/// The sections for summaries and slopes.
const GROUND_ALONE: Sections = Sections::TERRAIN.and(Sections::RELIEF).and(Sections::SPANS);

/// The tiles of a package, from any source of bytes. Loading a tile is asynchronous and blocks no
/// thread. [`PackageSource`](super::PackageSource) is a package in a file, for threads that may
/// wait.
#[derive(Debug)]
pub struct PackageTiles<S> {
    /// The package.
    pub package: Package<S>,
    /// Tiles of the package and all their ancestors.
    tiles: BTreeSet<TileId>,
    decoder: TileDecoder,
}

impl<S: ByteSource> PackageTiles<S> {
    /// Lists a package's tiles.
    ///
    /// # Errors
    /// When its directories cannot be read or are damaged.
    pub async fn new(package: Package<S>) -> Result<Self, OpenError> {
        let mut tiles = BTreeSet::new();
        for id in package.tile_ids().await? {
            let mut next = Some(id);
            while let Some(id) = next.filter(|id| tiles.insert(*id)) {
                next = id.parent();
            }
        }
        Ok(Self { package, tiles, decoder: TileDecoder::default() })
    }

    /// Sets the decoder of the tiles; by default all that a picture may show is read.
    #[must_use]
    pub fn with_decoder(self, decoder: TileDecoder) -> Self {
        Self { decoder, ..self }
    }

    /// Reads errors and heights of an existing tile; `None` without ground.
    ///
    /// # Errors
    /// When the tile cannot be read or is damaged.
    pub async fn summary_of(&self, id: TileId) -> Result<Option<GroundSummary>, LoadTileError> {
        let bytes = self.payload_for(id, GROUND_ALONE).await?;
        let Some(bytes) = bytes else { return Ok(None) };
        self.summary_in(&bytes, id)
    }

    fn summary_in(
        &self,
        payload: &[u8],
        id: TileId,
    ) -> Result<Option<GroundSummary>, LoadTileError> {
        let quantum_m = self.manifest().vertical.quantum_m;
        let summary = terrain_summary(payload, id, self.frame(), quantum_m)
            .map_err(LoadTileError::for_tile(id))?;
        let spans = self.decoder.spans(payload, id, self.manifest());
        let spans = spans.map_err(LoadTileError::for_tile(id))?;
        let summary = summary.map(|ground| GroundSummary {
            geometric_error_m: ground.geometric_error_m,
            height_range_m: ground.height_range_m,
        });
        let spans = spans.unwrap_or_default();
        Ok(summary.map(|ground| ground.with_bridges(&spans, quantum_m)))
    }

    /// Reads only the slopes, errors and heights of an existing tile.
    ///
    /// # Errors
    /// When the tile cannot be read or is damaged.
    pub async fn slopes_of(&self, id: TileId) -> Result<TileGeometry, LoadTileError> {
        let bytes = self.payload_for(id, GROUND_ALONE).await?;
        let tile = TileGeometry::empty(id, self.frame());
        let Some(bytes) = bytes else { return Ok(tile) };
        let summary = self.summary_in(&bytes, id)?;
        if summary.is_none() {
            return Ok(tile);
        }
        let payload = self.manifest().decode(&bytes, id, Sections::RELIEF);
        let payload = payload.map_err(LoadTileError::for_tile(id))?;
        let cell = self.frame().level_cell(id.z());
        let shading = payload.relief.as_ref().map(|relief| ShadingSlopes::new(relief, cell));
        Ok(TileGeometry { summary, shading, ..tile })
    }

    /// Reads and decodes an existing tile.
    ///
    /// # Errors
    /// When the tile cannot be read or is damaged.
    pub async fn tile(&self, id: TileId) -> Result<TileGeometry, LoadTileError> {
        let bytes = self.payload_for(id, self.decoder.sections()).await?;
        self.decoder.tile(bytes.as_deref(), id, self.manifest())
    }

    /// Whether any tile may have roads with this decoder.
    #[must_use]
    pub fn may_have_roads(&self) -> bool {
        may_have_roads(self.manifest(), self.decoder.sections())
    }

    /// The bytes of an existing tile, as far as these sections need them, for decoding elsewhere;
    /// `None` if only descendants of the tile are stored.
    ///
    /// # Errors
    /// When the bytes cannot be read.
    pub async fn payload_for(
        &self,
        id: TileId,
        wanted: Sections,
    ) -> Result<Option<Vec<u8>>, LoadTileError> {
        let bytes = self.package.tile_for(id, wanted).await;
        bytes.map_err(LoadTileError::for_tile(id))
    }
}

/// Whether tiles of a package may have roads if these sections are read.
#[must_use]
pub fn may_have_roads(manifest: &Manifest, read: Sections) -> bool {
    read.contains(Sections::ATTRIBUTES) && manifest.counts.roads_kept > 0
}

impl<S: ByteSource> TileCatalog for PackageTiles<S> {
    fn frame(&self) -> &GridFrame {
        &self.manifest().frame
    }

    fn exists(&self, id: TileId) -> bool {
        self.tiles.contains(&id)
    }
}

impl<S: ByteSource> MapPackage for PackageTiles<S> {
    fn manifest(&self) -> &Manifest {
        self.package.manifest()
    }
}
