//! What the store has of a layer: the section of each tile, and what is known of all objects together.

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

/// The encoded section of a tile, and how much is in it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct TileSection {
    /// The encoded section.
    pub section: Vec<u8>,
    /// The number of its objects, or of their parts.
    pub parts: u64,
    /// The number of the points of all of them.
    pub points: u64,
}

impl TileSection {
    /// Keeps what `encode` makes of the parts of a tile, if they make a section, with the numbers of parts and points.
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

    /// The section of a tile; `None` if it has none of the layer.
    ///
    /// # Errors
    /// When it cannot be kept or read, or makes no sense.
    pub fn get(
        layer: SectionLayer,
        store: &dyn Artifacts,
        id: TileId,
    ) -> Result<Option<Self>, ArtifactError> {
        artifacts::get(store, layer.section().of_tile(id))
    }
}

/// What the section of a tile takes; all 0 without one.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct SectionOfTile {
    /// The number of its objects, or of their parts.
    pub parts: u64,
    /// The number of the points of all of them.
    pub points: u64,
    /// The size of the section as it is stored.
    pub bytes: u64,
}

/// Sums over the sections of a level.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SectionSums {
    /// Tiles that have a section.
    pub tiles: u64,
    /// The number of its objects, or of their parts.
    pub parts: u64,
    /// The number of the points of all of them.
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

/// Counts of a layer of the extract: `objects = kept + lost`. They are kept after all sections. `M` is what its objects are measured in.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct LayerTotals<M> {
    /// Objects of the layer in the extract.
    pub objects: u64,
    /// Number and measure of those of each class, by the class's number.
    pub kept: BTreeMap<u8, (u64, M)>,
    /// How many were lost, by reason.
    pub(crate) lost: BTreeMap<String, u64>,
}

/// Areas, in square metres.
pub type AreaTotals = LayerTotals<f64>;
/// Ways of a layer of lines, in micrometres.
pub type LineTotals = LayerTotals<u64>;

impl<M: Serialize + DeserializeOwned> LayerTotals<M> {
    /// Keeps them for a layer.
    ///
    /// # Errors
    /// When it cannot be kept or read, or makes no sense.
    pub fn put(&self, layer: SectionLayer, store: &dyn Artifacts) -> Result<(), ArtifactError> {
        artifacts::put(store, layer.totals().item(0), self)
    }

    /// `None` in a build without the layer.
    ///
    /// # Errors
    /// When it cannot be kept or read, or makes no sense.
    pub fn get(layer: SectionLayer, store: &dyn Artifacts) -> Result<Option<Self>, ArtifactError> {
        artifacts::get(store, layer.totals().item(0))
    }

    /// Whether the extract has an object that was taken.
    pub(crate) fn has_any(&self) -> bool {
        self.kept.values().any(|&(objects, _)| objects > 0)
    }

    /// How many objects were lost, by reason.
    fn lost(&self) -> Vec<(String, u64)> {
        self.lost.iter().map(|(reason, &objects)| (reason.clone(), objects)).collect()
    }
}

impl AreaTotals {
    /// What the manifest says of them.
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
    /// What the manifest says of them.
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
