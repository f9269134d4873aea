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
pub(crate) mod parts_by_tile;
pub(crate) mod plan_splitting;
pub mod tile_section;

use std::ops::{Index, IndexMut};

use corniche_spec::artifacts::ArtifactKind;
use corniche_tileset::{PayloadSizes, Section, SectionSize};
use corniche_work::Stage;
use serde::{Deserialize, Serialize};

corniche_roads::listed! {
    /// A layer for which each tile has a section.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum SectionLayer {
        /// Areas of the extract.
        Areas = (Stage::MapAreas, ArtifactKind::AreaSection, ArtifactKind::AreaTotals),
        /// Boundaries of the extract.
        Boundaries = (Stage::Boundaries, ArtifactKind::BoundarySection, ArtifactKind::BoundaryTotals),
        /// Bridges and tunnels.
        Spans = (Stage::Spans, ArtifactKind::SpanSection, ArtifactKind::SpanTotals),
    }

    /// The stage that is reported while its objects are split, and the kinds of the artifacts with
    /// a tile's section and with the totals.
    fn row() -> (Stage, ArtifactKind, ArtifactKind);
}

impl SectionLayer {
    /// The layers that are complete before the tiles are built: all but spans (bridges and
    /// tunnels), which need the ground of all tiles.
    pub const OF_EXTRACT: [Self; 2] = [Self::Areas, Self::Boundaries];

    /// The stage that is reported while the layer's objects are split.
    pub(crate) fn stage(self) -> Stage {
        self.row().0
    }

    /// The kind of the artifact with the section of a tile.
    #[must_use]
    pub fn section(self) -> ArtifactKind {
        self.row().1
    }

    /// The kind of the artifact with the totals.
    #[must_use]
    pub fn totals(self) -> ArtifactKind {
        self.row().2
    }

    /// The section of a payload with these bytes from the store.
    #[must_use]
    pub fn section_of(self, bytes: Vec<u8>) -> Section {
        match self {
            Self::Areas => Section::of_areas(bytes),
            Self::Boundaries => Section::of_boundaries(bytes),
            Self::Spans => Section::of_spans(bytes),
        }
    }

    /// The size of the layer's section in a payload with these sizes.
    #[must_use]
    pub fn size_in(self, sizes: &PayloadSizes) -> SectionSize {
        match self {
            Self::Areas => sizes.areas,
            Self::Boundaries => sizes.boundaries,
            Self::Spans => sizes.spans,
        }
    }
}

/// A value for each layer that has sections.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct ByLayer<T>([T; SectionLayer::ALL.len()]);

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
