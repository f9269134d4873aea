//! What the layers of an extract have in common: objects come in, are split by level and tile, and what belongs to a tile is sorted together.
//!
//! ```text
//!  extract ─► objects ─► parts by level and tile ─► sorted by tile ─► one artifact for each tile
//!                  └───► totals
//! ```
//!
//! Roads are laid on the ground of each tile, so what is kept of them are pieces. The parts of other layers are encoded at once, as a section
//! of their tile.

pub(crate) mod blocks;
pub mod defects;
pub mod fixed_points;
pub(crate) mod layer_writer;
pub(crate) mod parts_by_tile;
pub(crate) mod plan_splitting;
pub mod tile_section;

use std::{
    iter,
    ops::{Index, IndexMut},
};

use corniche_areas::ClassedLayer;
use corniche_spec::artifacts::Kind;
use corniche_tileset::{PayloadSizes, Section, SectionSize};
use corniche_work::Stage;
use serde::{Deserialize, Serialize};

/// A layer of which each tile has a section.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SectionLayer {
    /// Areas of the extract.
    Areas,
    /// A layer of lines.
    Lines(ClassedLayer),
    /// Bridges and tunnels.
    Spans,
}

impl SectionLayer {
    /// How many there are.
    const COUNT: usize = 2 + ClassedLayer::ALL.len();

    /// All of them, in the order of their sections.
    pub fn all() -> impl Iterator<Item = Self> {
        iter::once(Self::Areas)
            .chain(ClassedLayer::ALL.map(Self::Lines))
            .chain(iter::once(Self::Spans))
    }

    /// The layers that are there before their tiles are: all but spans, which need the ground of all tiles.
    pub fn of_extract() -> impl Iterator<Item = Self> {
        Self::all().filter(|layer| *layer != Self::Spans)
    }

    fn place(self) -> usize {
        match self {
            Self::Areas => 0,
            Self::Lines(layer) => 1 + layer as usize,
            Self::Spans => Self::COUNT - 1,
        }
    }

    /// What is told while its objects are split, and the artifacts that hold the section of a tile and the totals.
    const fn row(self) -> (Stage, Kind, Kind) {
        match self {
            Self::Areas => (Stage::MapAreas, Kind::AreaSection, Kind::AreaTotals),
            Self::Lines(ClassedLayer::Boundaries) => {
                (Stage::Boundaries, Kind::BoundarySection, Kind::BoundaryTotals)
            }
            Self::Spans => (Stage::Spans, Kind::SpanSection, Kind::SpanTotals),
        }
    }

    /// What is told while its objects are split.
    pub(crate) fn stage(self) -> Stage {
        self.row().0
    }

    /// The artifact that holds the section of a tile.
    #[must_use]
    pub fn section(self) -> Kind {
        self.row().1
    }

    /// The artifact that holds the totals.
    #[must_use]
    pub fn totals(self) -> Kind {
        self.row().2
    }

    /// The section of a payload with these bytes, which were kept.
    #[must_use]
    pub fn section_of(self, bytes: Vec<u8>) -> Section {
        match self {
            Self::Areas => Section::of_areas(bytes),
            Self::Lines(layer) => Section::of_lines(layer, bytes),
            Self::Spans => Section::of_spans(bytes),
        }
    }

    /// What its section takes in a payload with these sizes.
    #[must_use]
    pub fn size_in(self, sizes: &PayloadSizes) -> SectionSize {
        match self {
            Self::Areas => sizes.areas,
            Self::Lines(layer) => sizes.lines[layer as usize],
            Self::Spans => sizes.spans,
        }
    }
}

/// A value for each layer that has sections.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct ByLayer<T>([T; SectionLayer::COUNT]);

impl<T> Index<SectionLayer> for ByLayer<T> {
    type Output = T;

    fn index(&self, layer: SectionLayer) -> &T {
        &self.0[layer.place()]
    }
}

impl<T> IndexMut<SectionLayer> for ByLayer<T> {
    fn index_mut(&mut self, layer: SectionLayer) -> &mut T {
        &mut self.0[layer.place()]
    }
}
