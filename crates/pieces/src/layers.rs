//! The common steps of all layers of the extract: objects are read, split by level and tile, and
//! sorted so that the parts of a tile are together.
//!
//! ```text
//!  extract ─► objects ─► parts by level and tile ─► sorted by tile ─► one artifact for each tile
//!                  └───► totals
//! ```
//!
//! Roads are draped on the ground of each tile, so they are stored as pieces. The parts of other
//! layers are encoded at once, as a section of their tile.

pub(crate) mod blocks;
pub mod defects;
pub mod fixed_points;
pub(crate) mod layer_writer;
pub(crate) mod object_layer;
pub(crate) mod parts_by_tile;
pub(crate) mod plan_splitting;
pub(crate) mod segment_run;
pub mod span_pieces;
pub mod tile_section;

use corniche_spec::artifacts::ArtifactKind;
use corniche_store::ArtifactKey;
use corniche_tileset::{LayerSlot, Section};

/// A layer for which each tile has a section.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SectionLayer {
    /// A layer of the extract. It is complete before the tiles are built.
    Extract(LayerSlot),
    /// Bridges and tunnels, which need the ground of all tiles.
    Spans,
}

impl SectionLayer {
    /// The key of the artifact with the section of a tile, which has this number in the order of
    /// the package.
    #[must_use]
    pub fn section_key(self, tile: u64) -> ArtifactKey {
        match self {
            Self::Extract(slot) => in_tile(ArtifactKind::LayerSection, slot, tile),
            Self::Spans => ArtifactKind::SpanSection.item(tile),
        }
    }

    /// The key of the artifact with the totals.
    #[must_use]
    pub fn totals_key(self) -> ArtifactKey {
        match self {
            Self::Extract(slot) => ArtifactKind::LayerTotals.item(slot.index() as u64),
            Self::Spans => ArtifactKind::SpanTotals.item(0),
        }
    }

    /// The section of a payload with these bytes from the store.
    #[must_use]
    pub fn section_of(self, bytes: Vec<u8>) -> Section {
        match self {
            Self::Extract(slot) => Section::of_layer(slot, bytes),
            Self::Spans => Section::of_spans(bytes),
        }
    }
}

/// The key of an artifact of a layer in a tile.
pub(crate) fn in_tile(kind: ArtifactKind, slot: LayerSlot, tile: u64) -> ArtifactKey {
    // Numbers of tiles have at most 55 bits.
    kind.item((slot.index() as u64) << 56 | tile)
}

/// The layers of a package, in their order.
pub fn extract_layers(count: usize) -> impl Iterator<Item = SectionLayer> {
    (0..count).map_while(LayerSlot::new).map(SectionLayer::Extract)
}
