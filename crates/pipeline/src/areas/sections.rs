//! The areas section of each tile in the store.

use corniche_geom::TileId;
use corniche_store::Artifacts;
use corniche_tileset::AreasSection;
use serde::{Deserialize, Serialize};

use crate::{
    BuildError,
    artifacts::{self, Kind},
};

/// The encoded section of a tile, and how much is in it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct TileAreas {
    pub(crate) section: Vec<u8>,
    pub(crate) areas: u64,
    /// The number of points of all rings.
    pub(crate) points: u64,
}

impl TileAreas {
    pub(crate) fn put(&self, store: &dyn Artifacts, id: TileId) -> Result<(), BuildError> {
        artifacts::put(store, Kind::AreaSection.of_tile(id), self)
    }

    /// The sections of a tile; `None` if it has no areas.
    pub(crate) fn get(store: &dyn Artifacts, id: TileId) -> Result<Option<Self>, BuildError> {
        artifacts::get(store, Kind::AreaSection.of_tile(id))
    }

    /// The areas as the section of a payload.
    pub(crate) fn into_section(self) -> AreasSection {
        AreasSection::from_bytes(self.section)
    }
}
