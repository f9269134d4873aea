//! Decodes the bytes of a tile into drawable geometry.

use std::{cell::OnceCell, collections::BTreeMap, sync::Arc};

use corniche_geom::{MOST_TILE_STEPS, StepBudget, TileId, TooMuchWork};
use corniche_layers::{LayerGeometry, LinePlacement};
use corniche_styles::Style;
use corniche_tileset::{
    DecodeError, LayerObject, LayerShape, LayerSlot, Manifest, Sections, SpanRun, decode_photo,
};
use serde::{Deserialize, Serialize};

use super::{
    LineLayers, LineMethods, LoadTileError, Overlays, PhotoImage, PlanScale, StyledLine,
    TileGeometry, TileSurface,
};
use crate::{
    layer_class::LayerClass,
    line_places::{LineLayer, LinePlaces},
    options::{Mapping, RoadMethod},
};

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
    has_photos: bool,
    /// The layers that are read; `None` for all.
    layers: Option<Vec<LayerSlot>>,
    mapping: Mapping,
    /// The overlays, which are not transferred to other instances.
    #[serde(skip)]
    overlays: Arc<Overlays>,
}

impl Default for TileDecoder {
    /// Reads everything that a picture may show: roads for both methods, photos and all layers.
    fn default() -> Self {
        Self {
            sections: GROUND | Sections::ROADS_GEO | Sections::ROADS_SV | Sections::ATTRIBUTES,
            has_photos: true,
            layers: None,
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

    /// Reads only what a picture in this style shows, with roads by this method: no photos if the
    /// style hides them, and only the layers that are drawn. If there are photos, they take most of
    /// the time and memory.
    #[must_use]
    pub fn for_look(self, method: RoadMethod, style: &Style, drawn: Vec<LayerSlot>) -> Self {
        self.for_method(method).with_layers_of(style, drawn)
    }

    /// Reads photos only if the style shows them, and only the layers that are drawn.
    #[must_use]
    pub fn with_layers_of(self, style: &Style, drawn: Vec<LayerSlot>) -> Self {
        Self { has_photos: style.photo > 0.0, layers: Some(drawn), ..self }
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
        let of = |is_read, section| if is_read { section } else { Sections::NONE };
        let has_layers = self.layers.as_ref().is_none_or(|layers| !layers.is_empty());
        self.sections
            | Sections::SPANS
            | of(self.has_photos, Sections::PHOTO)
            | of(has_layers, Sections::LAYERS)
    }

    fn reads(&self, layer: LayerSlot) -> bool {
        self.layers.as_ref().is_none_or(|layers| layers.contains(&layer))
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

    /// The bridges and tunnels of a tile; `None` if the package has no data about them, or neither
    /// roads are read nor layers with bridges and tunnels.
    pub(crate) fn spans(
        &self,
        payload: &[u8],
        id: TileId,
        manifest: &Manifest,
    ) -> Result<Option<Vec<SpanRun>>, DecodeError> {
        let mut of_layers = manifest.layers().filter(|(slot, _)| self.reads(*slot));
        let is_wanted = self.sections.contains(Sections::ATTRIBUTES)
            || of_layers.any(|(_, record)| record.table.placement == LinePlacement::Spans);
        if manifest.spans.is_none() || !is_wanted {
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
        let has_roads = self.sections.contains(Sections::ATTRIBUTES);
        let tile = TileGeometry::from_payload(
            &decoded,
            spans.filter(|_| has_roads),
            frame,
            quantum_m,
            (margin_m, scale),
            self.mapping,
        )?;
        let surface = OnceCell::new();
        let surface = || {
            let ground = decoded.terrain.as_ref()?;
            Some(surface.get_or_init(|| TileSurface::new(&tile, &ground.tin, manifest)))
        };
        let mut lines = LineLayers::default();
        let margin = (margin_m / frame.lattice_step_m()).ceil() as i64;
        let overlays = self.overlays.near(id, frame, margin);
        let mut others = Vec::new();
        let (methods, work) = (self.line_methods(), StepBudget::new(MOST_TILE_STEPS));
        let places = LinePlaces::from_manifest(manifest);
        for (slot, record) in manifest.layers() {
            if !self.reads(slot) {
                continue;
            }
            let objects = manifest.decode_layer(payload, id, slot)?;
            if record.table.geometry != LayerGeometry::Line {
                others.push((slot, objects));
                continue;
            }
            let runs = spans.unwrap_or_default().iter();
            let runs: Vec<&SpanRun> = runs.filter(|run| run.owner.layer() == Some(slot)).collect();
            for (layer, of_layer) in by_group(objects, slot, &places) {
                if let Some(surface) = surface() {
                    lines.add(layer, surface.lay_within((&of_layer, &runs), methods, &work)?);
                }
            }
        }
        if !overlays.is_empty()
            && let Some(surface) = surface()
        {
            let laid = surface.lay(&overlays, methods).map_err(|source| TooManyOverlays {
                files: self.overlays.names_of(&overlays),
                source,
            })?;
            lines.add(LineLayer::Overlays, laid);
        }
        let mut tile = TileGeometry { lines, ..tile.with_layers(others, frame)? };
        if self.has_photos {
            tile.photo = decode_photo(payload, id)?.map(PhotoImage::new);
        }
        Ok(tile)
    }
}

/// The lines of a layer, by the groups in which they are drawn.
fn by_group(
    objects: Vec<LayerObject>,
    layer: LayerSlot,
    places: &LinePlaces,
) -> BTreeMap<LineLayer, Vec<StyledLine>> {
    let mut groups: BTreeMap<LineLayer, Vec<StyledLine>> = BTreeMap::new();
    for LayerObject { class, object, shape, .. } in objects {
        let place = places.place(LayerClass { layer, class });
        if let (LayerShape::Line(points), Some((group, style))) = (shape, place) {
            groups.entry(group).or_default().push(StyledLine { id: object.id(), style, points });
        }
    }
    groups
}

#[cfg(test)]
#[path = "decoder_tests.rs"]
mod tests;
