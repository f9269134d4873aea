//! The artifacts of a layer: the section of each tile, and the totals of all objects.

use std::collections::BTreeMap;

use corniche_geom::TileId;
use corniche_spec::artifacts::{self, ArtifactError};
use corniche_store::Artifacts;
use corniche_tileset::{
    AreaClassRecord, AreaCounts, EncodeError, LineClassRecord, LineCounts, Section,
};
use serde::{Deserialize, Serialize, de::DeserializeOwned};

use super::SectionLayer;
use crate::ExtractError;

/// The encoded section of a tile, with its counts.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct TileSection {
    /// The encoded section.
    pub section: Vec<u8>,
    /// The number of its objects, or of their parts.
    pub parts: u64,
    /// The number of points of all parts.
    pub points: u64,
}

impl TileSection {
    /// Encodes the parts of a tile with `encode` and stores the section, if there is one, with the
    /// numbers of parts and points.
    ///
    /// # Errors
    /// See [`ExtractError`].
    pub fn put(
        (layer, tile): (SectionLayer, u64),
        store: &dyn Artifacts,
        [parts, points]: [u64; 2],
        encode: impl FnOnce(TileId) -> Result<Option<Section>, EncodeError>,
    ) -> Result<(), ExtractError> {
        let key = layer.section().item(tile);
        let id = artifacts::tile_of(key)?;
        let Some(section) = encode(id)?.map(Section::into_bytes) else { return Ok(()) };
        Ok(artifacts::put(store, key, &Self { section, parts, points })?)
    }

    /// Reads the section of a tile; `None` if it has none of the layer.
    ///
    /// # Errors
    /// When the artifact cannot be read or is invalid.
    pub fn get(
        layer: SectionLayer,
        store: &dyn Artifacts,
        id: TileId,
    ) -> Result<Option<Self>, ArtifactError> {
        artifacts::get(store, layer.section().of_tile(id))
    }
}

/// The counts and size of a tile's section; all 0 without a section.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct SectionOfTile {
    /// The number of its objects, or of their parts.
    pub parts: u64,
    /// The number of points of all parts.
    pub points: u64,
    /// The size of the section as it is stored.
    pub bytes: u64,
}

/// Sums over the sections of a level.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SectionSums {
    /// Tiles that have a section.
    pub tiles: u64,
    /// The number of the layer's objects, or of their parts.
    pub parts: u64,
    /// The number of points of all parts.
    pub points: u64,
    /// Bytes of the sections.
    pub bytes: u64,
}

impl SectionSums {
    /// Adds the section of a tile.
    pub fn add(&mut self, of_tile: SectionOfTile) {
        self.tiles += u64::from(of_tile.parts > 0);
        self.parts += of_tile.parts;
        self.points += of_tile.points;
        self.bytes += of_tile.bytes;
    }
}

/// Counts of a layer of the extract: `objects = kept + lost`. They are stored after all sections.
/// `M` is the measure of the layer's objects.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct LayerTotals<M> {
    /// Objects of the layer in the extract.
    pub objects: u64,
    /// Number and measure of the kept objects of each class, by the class's number.
    pub kept: BTreeMap<u8, (u64, M)>,
    /// The number of lost objects, by reason.
    pub(crate) lost: BTreeMap<String, u64>,
}

/// Areas, in square metres.
pub type AreaTotals = LayerTotals<f64>;
/// Ways of boundaries, in micrometres.
pub type LineTotals = LayerTotals<u64>;

impl<M: Serialize + DeserializeOwned> LayerTotals<M> {
    /// Stores the totals of a layer.
    ///
    /// # Errors
    /// When the artifact cannot be stored.
    pub fn put(&self, layer: SectionLayer, store: &dyn Artifacts) -> Result<(), ArtifactError> {
        artifacts::put(store, layer.totals().item(0), self)
    }

    /// Reads the totals of a layer; `None` in a build without the layer.
    ///
    /// # Errors
    /// When the artifact cannot be read or is invalid.
    pub fn get(layer: SectionLayer, store: &dyn Artifacts) -> Result<Option<Self>, ArtifactError> {
        artifacts::get(store, layer.totals().item(0))
    }

    /// Whether the extract has an object of this layer.
    pub(crate) fn has_any(&self) -> bool {
        self.kept.values().any(|&(objects, _)| objects > 0)
    }

    /// The number of lost objects, by reason.
    fn lost(&self) -> Vec<(String, u64)> {
        self.lost.iter().map(|(reason, &objects)| (reason.clone(), objects)).collect()
    }
}

impl AreaTotals {
    /// The manifest's record of these totals.
    #[must_use]
    pub fn counts(&self) -> AreaCounts {
        let class = |(&class, &(areas, area_m2)): (&u8, &(u64, f64))| AreaClassRecord {
            class,
            areas,
            area_km2: area_m2 / 1e6,
        };
        let kept = self.kept.iter().map(class).collect();
        AreaCounts { objects: self.objects, kept, lost: self.lost() }
    }
}

impl LineTotals {
    /// The manifest's record of these totals.
    #[must_use]
    pub fn counts(&self) -> LineCounts {
        let class = |(&class, &(ways, length_um)): (&u8, &(u64, u64))| LineClassRecord {
            class,
            ways,
            length_um,
        };
        let kept = self.kept.iter().map(class).collect();
        LineCounts { ways: self.objects, kept, lost: self.lost() }
    }
}
