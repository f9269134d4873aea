//! From the bytes of a tile to what is drawn of it.

use std::sync::Arc;

use corniche_areas::ClassedLayer;
use corniche_geom::{TileId, TooMuchWork};
use corniche_styles::Style;
use corniche_tileset::{
    DecodeError, Manifest, Sections, SpanRun, decode, decode_areas, decode_lines, decode_photo,
    decode_spans,
};
use serde::{Deserialize, Serialize};

use super::{
    LayerLine, LineLayer, LineMethods, LoadTileError, Overlays, PhotoImage, PlanScale,
    TileGeometry, TileLines, geometry::LineGround,
};
use crate::options::{Mapping, RoadMethod};

/// The lines of people's own files take too much work on a tile.
#[derive(Debug, thiserror::Error)]
#[error(
    "the lines of {files} cross too much of its ground with too many points; simplify them (ogr2ogr -simplify), or cut them to what is shown \
     (ogr2ogr -clipsrc)"
)]
struct TooManyOverlays {
    files: String,
    source: TooMuchWork,
}

/// What every picture needs of a tile.
const GROUND: Sections = Sections::TERRAIN.and(Sections::RELIEF);

/// Whether a layer of tiles is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
enum Layer {
    Read,
    LeftOut,
}

impl Layer {
    fn of(is_shown: bool) -> Self {
        if is_shown { Self::Read } else { Self::LeftOut }
    }
}

/// What is read of tiles. It needs no package, only its manifest: tiles may be decoded in other threads, or in the workers of a page.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct TileDecoder {
    sections: Sections,
    photos: Layer,
    areas: Layer,
    boundaries: Layer,
    mapping: Mapping,
    /// They do not go to other instances.
    #[serde(skip)]
    overlays: Arc<Overlays>,
}

impl Default for TileDecoder {
    /// Reads all that a picture may show: roads for both methods, photos, areas and boundaries.
    fn default() -> Self {
        Self {
            sections: GROUND | Sections::ROADS_GEO | Sections::ROADS_SV | Sections::ATTRIBUTES,
            photos: Layer::Read,
            areas: Layer::Read,
            boundaries: Layer::Read,
            mapping: Mapping::default(),
            overlays: Arc::default(),
        }
    }
}

impl TileDecoder {
    /// Reads, beside the ground, only the roads that one method needs, with their attributes.
    #[must_use]
    pub fn for_method(self, method: RoadMethod) -> Self {
        let roads = match method {
            RoadMethod::Geometry => Sections::ROADS_GEO | Sections::ATTRIBUTES,
            RoadMethod::ShadowVolumes => Sections::ROADS_SV | Sections::ATTRIBUTES,
            RoadMethod::None => Sections::NONE,
        };
        Self { sections: GROUND | roads, ..self }
    }

    /// Reads only what a picture in this style shows, with roads by this method: no photos, areas or boundaries where the style hides
    /// them. Photos take most of the time and the memory where there are some.
    #[must_use]
    pub fn for_look(self, method: RoadMethod, style: &Style) -> Self {
        self.for_method(method).with_layers_of(style)
    }

    /// Reads photos, areas and boundaries only where the style shows them.
    #[must_use]
    pub fn with_layers_of(self, style: &Style) -> Self {
        Self {
            photos: Layer::of(style.photo > 0.0),
            areas: Layer::of(style.has_areas()),
            boundaries: Layer::of(style.has_boundaries()),
            ..self
        }
    }

    /// Lays roads as geometry on the ground, or not.
    #[must_use]
    pub fn with_mapping(self, mapping: Mapping) -> Self {
        Self { mapping, ..self }
    }

    /// Lays lines of people's own files on the tiles.
    #[must_use]
    pub fn with_overlays(self, overlays: Arc<Overlays>) -> Self {
        Self { overlays, ..self }
    }

    /// The sections that it reads.
    #[must_use]
    pub fn sections(&self) -> Sections {
        let of_layer = |layer: Layer, sections| match layer {
            Layer::Read => sections,
            Layer::LeftOut => Sections::NONE,
        };
        self.sections
            | Sections::SPANS
            | of_layer(self.photos, Sections::PHOTO)
            | of_layer(self.areas, Sections::AREAS)
            | of_layer(self.boundaries, Sections::lines(ClassedLayer::Boundaries))
    }

    /// The methods for which lines are prepared: those of the roads that are read.
    fn line_methods(&self) -> LineMethods {
        match [Sections::ROADS_GEO, Sections::ROADS_SV].map(|of| self.sections.contains(of)) {
            [true, true] => LineMethods::Both,
            [true, false] => LineMethods::Geometry,
            [false, _] => LineMethods::ShadowVolumes,
        }
    }

    /// The tile of a package with this manifest; `None` for bytes stands for a tile that is not stored itself, but tiles beneath it are.
    ///
    /// # Errors
    /// When the bytes are damaged.
    pub fn tile(
        &self,
        payload: Option<&[u8]>,
        id: TileId,
        manifest: &Manifest,
    ) -> Result<TileGeometry, LoadTileError> {
        let (frame, quantum_m) = (&manifest.frame, manifest.vertical.quantum_m);
        let Some(bytes) = payload else {
            return Ok(TileGeometry::assemble(id, None, &TileLines::default(), frame, quantum_m));
        };
        let tile = self.read(bytes, id, manifest);
        tile.map_err(|source| LoadTileError { id, source })
    }

    /// The bridges and tunnels of a tile; `None` if the package tells nothing of them, or no roads are read.
    pub(crate) fn spans(
        &self,
        payload: &[u8],
        id: TileId,
        manifest: &Manifest,
    ) -> Result<Option<Vec<SpanRun>>, DecodeError> {
        if manifest.spans.is_none() || !self.sections.contains(Sections::ATTRIBUTES) {
            return Ok(None);
        }
        decode_spans(payload, id, &manifest.frame, manifest.vertical.quantum_m).map(Some)
    }

    fn read(
        &self,
        payload: &[u8],
        id: TileId,
        manifest: &Manifest,
    ) -> Result<TileGeometry, Box<dyn std::error::Error + Send + Sync>> {
        let Manifest { frame, coordinates, point_scale, .. } = manifest;
        let quantum_m = manifest.vertical.quantum_m;
        let decoded = decode(payload, id, frame, quantum_m, self.sections)?;
        // The manifest has a record for every level of the frame: the reader of manifests checks that.
        let margin_m = manifest.levels[usize::from(id.z())].width_margin_m;
        let scale = PlanScale::of_tile(coordinates, frame.tile_bounds(id), *point_scale);
        let on = LineGround {
            terrain: decoded.terrain.as_ref(),
            frame,
            quantum_m,
            scale: &scale,
            vertical_scale: *point_scale,
        };
        let spans = self.spans(payload, id, manifest)?;
        let spans = spans.as_deref();
        let tile = TileGeometry::from_payload(
            &decoded,
            spans,
            frame,
            quantum_m,
            (margin_m, scale),
            self.mapping,
        )?;
        let methods = self.line_methods();
        let boundaries = match self.boundaries {
            Layer::Read => decode_lines(payload, id, ClassedLayer::Boundaries)?,
            Layer::LeftOut => Vec::new(),
        };
        let boundaries: Vec<LayerLine> = boundaries.into_iter().map(LayerLine::from).collect();
        let tile = tile.with_lines(LineLayer::Boundaries, &boundaries, &on, methods)?;
        let margin = (margin_m / frame.lattice_step_m()).ceil() as i64;
        let overlays = self.overlays.near(id, frame, margin);
        let tile = tile.with_lines(LineLayer::Overlays, &overlays, &on, methods);
        let tile = tile.map_err(|source| TooManyOverlays {
            files: self.overlays.names_of(&overlays),
            source,
        })?;
        let areas = match self.areas {
            Layer::Read => decode_areas(payload, id, frame)?,
            Layer::LeftOut => Vec::new(),
        };
        let tile = tile.with_areas(&areas, frame)?;
        let photo = match self.photos {
            Layer::Read => decode_photo(payload, id)?,
            Layer::LeftOut => None,
        };
        Ok(TileGeometry { photo: photo.map(PhotoImage::new), ..tile })
    }
}

#[cfg(test)]
#[path = "decoder_tests.rs"]
mod tests;
