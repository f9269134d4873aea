//! The artifacts of a layer: the section of each tile, and the totals of all objects.

use std::collections::BTreeMap;

use corniche_geom::TileId;
use corniche_osm::{AreaLoss, AreaSummary, LineLoss, LineSummary, PointSummary};
use corniche_spec::artifacts::{self, ArtifactError, ArtifactKind};
use corniche_store::Artifacts;
use corniche_tileset::{EncodeError, LayerClassRecord, LayerCounts, Section, pmtiles_order};
use serde::{Deserialize, Serialize};

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
        let key = layer.section_key(tile);
        let id = artifacts::tile_of(ArtifactKind::Record.item(tile))?;
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
        artifacts::get(store, layer.section_key(pmtiles_order(id)))
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
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct LayerTotals {
    /// Objects of the layer in the extract.
    pub objects: u64,
    /// The kept objects of each class, by the class's number.
    pub kept: BTreeMap<u8, KeptObjects>,
    /// The number of lost objects, by reason.
    pub(crate) lost: BTreeMap<String, u64>,
    /// Values that are not of the kinds of their attributes, by key.
    pub(crate) unread: BTreeMap<String, u64>,
}

/// The kept objects of a class.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct KeptObjects {
    /// The number of objects.
    pub objects: u64,
    /// The size of these objects.
    pub(crate) measure: ObjectMeasure,
}

/// The true size of objects: lines have a length, areas an area.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct ObjectMeasure {
    /// Length in plan, micrometres.
    pub length_um: u64,
    /// Square metres.
    pub area_m2: f64,
}

impl ObjectMeasure {
    pub(crate) fn add(&mut self, other: Self) {
        self.length_um += other.length_um;
        self.area_m2 += other.area_m2;
    }
}

impl LayerTotals {
    /// Returns the totals of a reader's counts, without the sizes of the objects.
    fn from_counts<L>(
        objects: u64,
        kept: impl IntoIterator<Item = (u8, u64)>,
        (lost, reason): (BTreeMap<L, u64>, impl Fn(L) -> &'static str),
        unread: BTreeMap<String, u64>,
    ) -> Self {
        let measure = ObjectMeasure::default();
        Self {
            objects,
            kept: kept
                .into_iter()
                .map(|(class, objects)| (class, KeptObjects { objects, measure }))
                .collect(),
            lost: lost
                .into_iter()
                .map(|(loss, objects)| (reason(loss).to_owned(), objects))
                .collect(),
            unread,
        }
    }

    /// Stores the totals of a layer.
    ///
    /// # Errors
    /// When the artifact cannot be stored.
    pub fn put(&self, layer: SectionLayer, store: &dyn Artifacts) -> Result<(), ArtifactError> {
        artifacts::put(store, layer.totals_key(), self)
    }

    /// Reads the totals of a layer; `None` in a build without the layer.
    ///
    /// # Errors
    /// When the artifact cannot be read or is invalid.
    pub fn get(layer: SectionLayer, store: &dyn Artifacts) -> Result<Option<Self>, ArtifactError> {
        artifacts::get(store, layer.totals_key())
    }

    /// Whether the extract has an object of this layer.
    pub(crate) fn has_any(&self) -> bool {
        self.kept.values().any(|kept| kept.objects > 0)
    }

    /// The manifest's record of these totals.
    #[must_use]
    pub fn counts(&self) -> LayerCounts {
        let list = |counts: &BTreeMap<String, u64>| counts.clone().into_iter().collect();
        let class = |(&class, kept): (&u8, &KeptObjects)| LayerClassRecord {
            class,
            objects: kept.objects,
            length_um: kept.measure.length_um,
            area_km2: kept.measure.area_m2 / 1e6,
        };
        LayerCounts {
            objects: self.objects,
            kept: self.kept.iter().map(class).collect(),
            lost: list(&self.lost),
            unread_values: list(&self.unread),
        }
    }
}

impl From<AreaSummary> for LayerTotals {
    fn from(summary: AreaSummary) -> Self {
        let AreaSummary { objects, kept, lost, unread, .. } = summary;
        let kept = kept.into_iter().map(|(class, kept)| (class, kept.areas));
        Self::from_counts(objects, kept, (lost, AreaLoss::reason), unread)
    }
}

impl From<PointSummary> for LayerTotals {
    fn from(summary: PointSummary) -> Self {
        let PointSummary { objects, kept, lost, unread } = summary;
        Self::from_counts(objects, kept, (lost, AreaLoss::reason), unread)
    }
}

impl From<LineSummary> for LayerTotals {
    fn from(summary: LineSummary) -> Self {
        let LineSummary { ways, kept, lost, unread, .. } = summary;
        Self::from_counts(ways, kept, (lost, LineLoss::reason), unread)
    }
}
