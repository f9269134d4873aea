//! The boundaries section of each tile in the store.

use corniche_geom::TileId;
use corniche_store::Artifacts;
use corniche_tileset::BoundariesSection;
use serde::{Deserialize, Serialize};

use crate::{
    BuildError,
    artifacts::{self, Kind},
};

/// The encoded section of a tile, and how much is in it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct TileBoundaries {
    pub(crate) section: Vec<u8>,
    pub(crate) parts: u64,
    pub(crate) points: u64,
}

impl TileBoundaries {
    pub(crate) fn put(&self, store: &dyn Artifacts, id: TileId) -> Result<(), BuildError> {
        artifacts::put(store, Kind::BoundarySection.of_tile(id), self)
    }

    /// The sections of a tile; `None` if it has no boundaries.
    pub(crate) fn get(store: &dyn Artifacts, id: TileId) -> Result<Option<Self>, BuildError> {
        artifacts::get(store, Kind::BoundarySection.of_tile(id))
    }

    /// The boundaries as the section of a payload.
    pub(crate) fn into_section(self) -> BoundariesSection {
        BoundariesSection::from_bytes(self.section)
    }
}
