//! The section of a layer of each tile in the store.

use corniche_geom::TileId;
use corniche_spec::artifacts::{self, ArtifactError};
use corniche_store::Artifacts;
use corniche_tileset::{EncodeError, Section};
use serde::{Deserialize, Serialize};

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
