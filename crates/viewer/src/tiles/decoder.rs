//! Decodes the bytes of a tile into drawable geometry.

use std::sync::Arc;

use corniche_geom::{TileId, TooMuchWork};
use corniche_styles::Style;
use corniche_tileset::{
    DecodeError, Manifest, Sections, SpanRun, decode_areas, decode_boundaries, decode_photo,
};
use serde::{Deserialize, Serialize};

use super::{
    LayerLine, LineLayer, LineMethods, LoadTileError, Overlays, PhotoImage, PlanScale,
    TileGeometry, TileSurface,
};
use crate::options::{Mapping, RoadMethod};

/// The lines from users' files take too much work on a tile.
#[derive(Debug, thiserror::Error)]
#[error(
    "the lines of {files} have too many points on the ground of this tile; simplify the lines (ogr2ogr -simplify), or clip them to the area shown \
     (ogr2ogr -clipsrc)"
)]
struct TooManyOverlays {
    files: String,
    source: TooMuchWork,
}

/// The sections that every picture needs.
const GROUND: Sections = Sections::TERRAIN.and(Sections::RELIEF);

/// Which parts of tiles are read. It needs only the manifest of a package: tiles may be decoded in
/// other threads, or in the workers of a web page.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct TileDecoder {
    sections: Sections,
    /// Which of photos, areas and boundaries are read.
    layers: Sections,
    mapping: Mapping,
    /// The overlays, which are not transferred to other instances.
    #[serde(skip)]
    overlays: Arc<Overlays>,
}

impl Default for TileDecoder {
    /// Reads everything that a picture may show: roads for both methods, photos, areas and
    /// boundaries.
    fn default() -> Self {
        Self {
            sections: GROUND | Sections::ROADS_GEO | Sections::ROADS_SV | Sections::ATTRIBUTES,
            layers: Sections::PHOTO | Sections::AREAS | Sections::BOUNDARIES,
            mapping: Mapping::default(),
            overlays: Arc::default(),
        }
    }
}

impl TileDecoder {
    /// Reads, besides the ground, only the roads that one method needs, with their attributes.
    #[must_use]
    pub fn for_method(self, method: RoadMethod) -> Self {
        let roads = match method {
            RoadMethod::Geometry => Sections::ROADS_GEO | Sections::ATTRIBUTES,
            RoadMethod::ShadowVolumes => Sections::ROADS_SV | Sections::ATTRIBUTES,
            RoadMethod::None => Sections::NONE,
        };
        Self { sections: GROUND | roads, ..self }
    }

    /// Reads only what a picture in this style shows, with roads by this method: no photos, areas
    /// or boundaries if the style hides them. If there are photos, they take most of the time and
    /// memory.
    #[must_use]
    pub fn for_look(self, method: RoadMethod, style: &Style) -> Self {
        self.for_method(method).with_layers_of(style)
    }

    /// Reads photos, areas and boundaries only if the style shows them.
    #[must_use]
    pub fn with_layers_of(self, style: &Style) -> Self {
        let of = |is_shown, layer| if is_shown { layer } else { Sections::NONE };
        let layers = of(style.photo > 0.0, Sections::PHOTO)
            | of(style.has_areas(), Sections::AREAS)
            | of(style.has_boundaries(), Sections::BOUNDARIES);
        Self { layers, ..self }
    }

    /// Sets whether roads as geometry are draped on the ground.
    #[must_use]
    pub fn with_mapping(self, mapping: Mapping) -> Self {
        Self { mapping, ..self }
    }

    /// Drapes lines from users' files on the tiles.
    #[must_use]
    pub fn with_overlays(self, overlays: Arc<Overlays>) -> Self {
        Self { overlays, ..self }
    }

    /// The sections to read.
    #[must_use]
    pub fn sections(&self) -> Sections {
        self.sections | Sections::SPANS | self.layers
    }

    /// The methods for which lines are prepared: the methods of the roads that are read.
    fn line_methods(&self) -> LineMethods {
        match [Sections::ROADS_GEO, Sections::ROADS_SV].map(|of| self.sections.contains(of)) {
            [true, true] => LineMethods::Both,
            [true, false] => LineMethods::Geometry,
            [false, _] => LineMethods::ShadowVolumes,
        }
    }

    /// Decodes a tile of a package with this manifest; `None` for bytes means that the tile itself
    /// is not stored, but some of its descendants are.
    ///
    /// # Errors
    /// When the bytes are damaged.
    pub fn tile(
        &self,
        payload: Option<&[u8]>,
        id: TileId,
        manifest: &Manifest,
    ) -> Result<TileGeometry, LoadTileError> {
        let Some(bytes) = payload else {
            return Ok(TileGeometry::empty(id, &manifest.frame));
        };
        self.read(bytes, id, manifest).map_err(LoadTileError::for_tile(id))
    }

    /// The bridges and tunnels of a tile; `None` if the package has no data about them, or no roads
    /// are read.
    pub(crate) fn spans(
        &self,
        payload: &[u8],
        id: TileId,
        manifest: &Manifest,
    ) -> Result<Option<Vec<SpanRun>>, DecodeError> {
        if manifest.spans.is_none() || !self.sections.contains(Sections::ATTRIBUTES) {
            return Ok(None);
        }
        manifest.decode_spans(payload, id).map(Some)
    }

    fn read(
        &self,
        payload: &[u8],
        id: TileId,
        manifest: &Manifest,
    ) -> Result<TileGeometry, Box<dyn std::error::Error + Send + Sync>> {
        let Manifest { frame, coordinates, point_scale, .. } = manifest;
        let quantum_m = manifest.vertical.quantum_m;
        let decoded = manifest.decode(payload, id, self.sections)?;
        // The manifest has a record for every level of the frame; the reader of manifests checks
        // this.
        let margin_m = manifest.levels[usize::from(id.z())].width_margin_m;
        let scale = PlanScale::of_tile(coordinates, frame.tile_bounds(id), *point_scale);
        let spans = self.spans(payload, id, manifest)?;
        let spans = spans.as_deref();
        let mut tile = TileGeometry::from_payload(
            &decoded,
            spans,
            frame,
            quantum_m,
            (margin_m, scale),
            self.mapping,
        )?;
        let methods = self.line_methods();
        let boundaries = if self.layers.contains(Sections::BOUNDARIES) {
            decode_boundaries(payload, id)?
        } else {
            Vec::new()
        };
        let boundaries: Vec<LayerLine> = boundaries.into_iter().map(LayerLine::from).collect();
        let margin = (margin_m / frame.lattice_step_m()).ceil() as i64;
        let overlays = self.overlays.near(id, frame, margin);
        let has_lines = !boundaries.is_empty() || !overlays.is_empty();
        if let Some(terrain) = decoded.terrain.filter(|_| has_lines) {
            let surface = TileSurface::new(&tile, &terrain.tin, manifest);
            tile.lines.set(LineLayer::Boundaries, surface.lay(&boundaries, methods)?);
            let overlays = surface.lay(&overlays, methods).map_err(|source| TooManyOverlays {
                files: self.overlays.names_of(&overlays),
                source,
            })?;
            tile.lines.set(LineLayer::Overlays, overlays);
        }
        if self.layers.contains(Sections::AREAS) {
            tile = tile.with_areas(&decode_areas(payload, id, frame)?, frame)?;
        }
        if self.layers.contains(Sections::PHOTO) {
            tile.photo = decode_photo(payload, id)?.map(PhotoImage::new);
        }
        Ok(tile)
    }
}

#[cfg(test)]
#[path = "decoder_tests.rs"]
mod tests;
