//! What the layers of an extract have in common: objects come in, are split by level and tile, and what belongs to a tile is sorted together.
//!
//! ```text
//!  extract ─► objects ─► parts by level and tile ─► sorted by tile ─► one artifact for each tile
//!                  └───► totals
//! ```
//!
//! Roads are laid on the ground of each tile, so what is kept of them are pieces. The parts of other layers are encoded at once, as a section
//! of their tile.

pub(crate) mod defects;
pub(crate) mod fixed_points;
pub(crate) mod layer_totals;
pub(crate) mod layer_writer;
pub(crate) mod parts_by_tile;
pub(crate) mod tile_section;

use std::ops::{Index, IndexMut};

use corniche_geom::TileId;
use corniche_tileset::{AreasSection, BoundariesSection, EncodeError, SectionSize};
use serde::{Deserialize, Serialize};

use crate::artifacts::Kind;

/// A layer of which each tile has a section.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SectionLayer {
    Areas,
    Boundaries,
}

impl SectionLayer {
    /// All of them, in the order of their sections.
    pub(crate) const ALL: [Self; 2] = [Self::Areas, Self::Boundaries];

    /// The artifact that holds the section of a tile.
    pub(crate) fn section(self) -> Kind {
        match self {
            Self::Areas => Kind::AreaSection,
            Self::Boundaries => Kind::BoundarySection,
        }
    }

    /// The artifact that holds the totals.
    pub(crate) fn totals(self) -> Kind {
        match self {
            Self::Areas => Kind::AreaTotals,
            Self::Boundaries => Kind::BoundaryTotals,
        }
    }

    /// Adds a section to the payload of a tile.
    pub(crate) fn add_to(
        self,
        payload: &[u8],
        id: TileId,
        section: Vec<u8>,
    ) -> Result<(Vec<u8>, SectionSize), EncodeError> {
        match self {
            Self::Areas => {
                corniche_tileset::with_areas(payload, id, AreasSection::from_bytes(section))
            }
            Self::Boundaries => corniche_tileset::with_boundaries(
                payload,
                id,
                BoundariesSection::from_bytes(section),
            ),
        }
    }
}

/// A value for each layer that has sections.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct ByLayer<T>([T; SectionLayer::ALL.len()]);

impl<T> Index<SectionLayer> for ByLayer<T> {
    type Output = T;

    fn index(&self, layer: SectionLayer) -> &T {
        &self.0[layer as usize]
    }
}

impl<T> IndexMut<SectionLayer> for ByLayer<T> {
    fn index_mut(&mut self, layer: SectionLayer) -> &mut T {
        &mut self.0[layer as usize]
    }
}
