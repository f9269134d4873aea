use std::{collections::BTreeSet, sync::Arc};

use corniche_geom::{Frame, TileId};
use corniche_tileset::{
    ByteSource, Manifest, OpenError, Package, Sections, decode, decode_areas, decode_boundaries,
    decode_photo, terrain_summary,
};

use super::{
    LayerLine, LineLayer, LineMethods, LoadTileError, MapPackage, Overlays, PhotoImage, PlanScale,
    ShadingSlopes, TileCatalog, TileGeometry, TileLines, geometry::LineGround,
};
use crate::{lod::GroundSummary, options::RoadMethod};

/// What every picture needs of a tile.
const GROUND: Sections = Sections::TERRAIN.and(Sections::RELIEF);

/// The tiles of a package, from any source of bytes. Loading a tile is asynchronous and blocks no thread.
/// [`PackageSource`](super::PackageSource) is a package in a file, for threads that may wait.
#[derive(Debug)]
pub struct PackageTiles<S> {
    package: Package<S>,
    /// Tiles of the package and all tiles above them.
    tiles: BTreeSet<TileId>,
    sections: Sections,
    photos: Photos,
    areas: AreasOfTiles,
    boundaries: BoundariesOfTiles,
    overlays: Arc<Overlays>,
}

/// Whether the photos of tiles are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Photos {
    Read,
    LeftOut,
}

/// Whether the areas of tiles are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum AreasOfTiles {
    Read,
    LeftOut,
}

/// Whether the boundaries of tiles are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum BoundariesOfTiles {
    Read,
    LeftOut,
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
        let sections = GROUND | Sections::ROADS_GEO | Sections::ROADS_SV | Sections::ATTRIBUTES;
        let overlays = Arc::default();
        let (photos, areas) = (Photos::Read, AreasOfTiles::Read);
        let boundaries = BoundariesOfTiles::Read;
        Ok(Self { package, tiles, sections, photos, areas, boundaries, overlays })
    }

    /// Reads, beside the ground, only the roads that one method needs, with their attributes; without this, the roads that both need.
    #[must_use]
    pub fn for_method(self, method: RoadMethod) -> Self {
        let roads = match method {
            RoadMethod::Geometry => Sections::ROADS_GEO | Sections::ATTRIBUTES,
            RoadMethod::ShadowVolumes => Sections::ROADS_SV | Sections::ATTRIBUTES,
            RoadMethod::None => Sections::NONE,
        };
        Self { sections: GROUND | roads, ..self }
    }

    /// Reads no photos, which take most of the time and the memory where there are some.
    #[must_use]
    pub fn without_photos(self) -> Self {
        Self { photos: Photos::LeftOut, ..self }
    }

    /// Reads no areas.
    #[must_use]
    pub fn without_areas(self) -> Self {
        Self { areas: AreasOfTiles::LeftOut, ..self }
    }

    /// Reads no boundaries.
    #[must_use]
    pub fn without_boundaries(self) -> Self {
        Self { boundaries: BoundariesOfTiles::LeftOut, ..self }
    }

    /// Lays lines of people's own files on the tiles.
    #[must_use]
    pub fn with_overlays(self, overlays: Arc<Overlays>) -> Self {
        Self { overlays, ..self }
    }

    /// For which methods lines are prepared: those of the roads that are read.
    fn line_methods(&self) -> LineMethods {
        match [Sections::ROADS_GEO, Sections::ROADS_SV].map(|of| self.sections.contains(of)) {
            [true, true] => LineMethods::Both,
            [true, false] => LineMethods::Geometry,
            [false, _] => LineMethods::ShadowVolumes,
        }
    }

    /// Reads errors and heights of a tile that exists; `None` without ground.
    ///
    /// # Errors
    /// When it cannot be read or is damaged.
    pub async fn summary(&self, id: TileId) -> Result<Option<GroundSummary>, LoadTileError> {
        let failed = |source| LoadTileError { id, source };
        let bytes = self.package.tile(id).await.map_err(|error| failed(error.into()))?;
        let Some(bytes) = bytes else { return Ok(None) };
        self.summary_in(&bytes, id)
    }

    fn summary_in(
        &self,
        payload: &[u8],
        id: TileId,
    ) -> Result<Option<GroundSummary>, LoadTileError> {
        let summary =
            terrain_summary(payload, id, self.frame(), self.manifest().vertical.quantum_m)
                .map_err(|error| LoadTileError { id, source: error.into() })?;
        Ok(summary.map(|ground| GroundSummary {
            geometric_error_m: ground.geometric_error_m,
            height_range_m: ground.height_range_m,
        }))
    }

    /// Reads the slopes, errors and heights of a tile that exists, and nothing else of it.
    ///
    /// # Errors
    /// When it cannot be read or is damaged.
    pub async fn load_slopes(&self, id: TileId) -> Result<TileGeometry, LoadTileError> {
        let failed = |source| LoadTileError { id, source };
        let quantum_m = self.manifest().vertical.quantum_m;
        let bytes = self.package.tile(id).await.map_err(|error| failed(error.into()))?;
        let none = TileLines::default();
        let tile = TileGeometry::assemble(id, None, &none, self.frame(), quantum_m);
        let Some(bytes) = bytes else { return Ok(tile) };
        let summary = self.summary_in(&bytes, id)?;
        if summary.is_none() {
            return Ok(tile);
        }
        let payload = decode(&bytes, id, self.frame(), quantum_m, Sections::RELIEF)
            .map_err(|error| failed(error.into()))?;
        let cell = self.frame().level_cell(id.z());
        let shading = payload.relief.as_ref().map(|relief| ShadingSlopes::new(relief, cell));
        Ok(TileGeometry { summary, shading, ..tile })
    }

    /// Reads and decodes a tile that exists.
    ///
    /// # Errors
    /// When it cannot be read or is damaged.
    pub async fn load(&self, id: TileId) -> Result<TileGeometry, LoadTileError> {
        let failed = |source| LoadTileError { id, source };
        let quantum_m = self.manifest().vertical.quantum_m;
        let bytes = self.package.tile(id).await.map_err(|error| failed(error.into()))?;
        match bytes {
            Some(bytes) => {
                let payload = decode(&bytes, id, self.frame(), quantum_m, self.sections)
                    .map_err(|error| failed(error.into()))?;
                // The manifest has a record for every level of the frame: the reader of manifests checks that.
                let level = &self.manifest().levels[usize::from(id.z())];
                let (frame, margin_m) = (self.frame(), level.width_margin_m);
                let Manifest { coordinates, point_scale, .. } = self.manifest();
                let scale = PlanScale::of_tile(coordinates, frame.tile_bounds(id), *point_scale);
                let on = LineGround {
                    terrain: payload.terrain.as_ref(),
                    frame,
                    quantum_m,
                    scale: &scale,
                    vertical_scale: *point_scale,
                };
                let tile = TileGeometry::from_payload(&payload, frame, quantum_m, margin_m, scale)
                    .map_err(|error| failed(error.into()))?;
                let methods = self.line_methods();
                let boundaries = match self.boundaries {
                    BoundariesOfTiles::Read => decode_boundaries(&bytes, id),
                    BoundariesOfTiles::LeftOut => Ok(Vec::new()),
                };
                let boundaries = boundaries.map_err(|error| failed(error.into()))?;
                let boundaries: Vec<LayerLine> =
                    boundaries.into_iter().map(LayerLine::from).collect();
                let tile = tile.with_lines(LineLayer::Boundaries, &boundaries, &on, methods);
                let margin = (margin_m / frame.lattice_step_m()).ceil() as i64;
                let overlays = self.overlays.near(id, frame, margin);
                let tile = tile.with_lines(LineLayer::Overlays, &overlays, &on, methods);
                let areas = match self.areas {
                    AreasOfTiles::Read => decode_areas(&bytes, id, frame),
                    AreasOfTiles::LeftOut => Ok(Vec::new()),
                };
                let areas = areas.map_err(|error| failed(error.into()))?;
                let tile = tile.with_areas(&areas, frame).map_err(|error| failed(error.into()))?;
                let photo = match self.photos {
                    Photos::Read => decode_photo(&bytes, id),
                    Photos::LeftOut => Ok(None),
                };
                let photo = photo.map_err(|error| failed(error.into()))?;
                Ok(TileGeometry { photo: photo.map(PhotoImage::new), ..tile })
            }
            // The tile itself is not stored, but a tile beneath it is.
            None => {
                Ok(TileGeometry::assemble(id, None, &TileLines::default(), self.frame(), quantum_m))
            }
        }
    }
}

impl<S: ByteSource> TileCatalog for PackageTiles<S> {
    fn frame(&self) -> &Frame {
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
