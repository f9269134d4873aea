//! Lines beside the roads: boundaries, and lines of people's own files. They are drawn as roads are, by both methods, over the roads.
//!
//! A package has such lines in plan, or none of them. What lies on the ground, and what the ground's heights are beside it, is found when
//! a tile is read, with the clipper that packages are made with: each line is cut at every edge of the tile's triangles, by exact
//! decisions on the lattice.

mod dashes;
mod lay;
mod overlays;

use corniche_geom::LatticePoint;
use corniche_tileset::LineRecord;
use serde::{Deserialize, Serialize};

pub use self::{lay::TileSurface, overlays::Overlays};
use super::{RoadSegments, RoadVolumes};

/// The layers of lines, from the lowest to the highest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LineLayer {
    /// Boundaries of the package.
    Boundaries,
    /// Lines of people's own files.
    Overlays,
    /// Lines that a person draws in the window.
    Drawn,
}

impl LineLayer {
    /// All layers, in the order in which they are drawn.
    pub const ALL: [Self; 3] = [Self::Boundaries, Self::Overlays, Self::Drawn];
}

/// A line in plan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LayerLine {
    /// Lines with one id are parts of one line: OSM's id of the way, or the number of a line of a file.
    pub id: i64,
    /// Which style of the layer it is drawn in, below [`LineStyle::MOST`](corniche_styles::LineStyle::MOST).
    pub style: u8,
    /// At least two points.
    pub points: Vec<LatticePoint>,
}

impl From<LineRecord> for LayerLine {
    fn from(LineRecord { way_id, class, points }: LineRecord) -> Self {
        Self { id: way_id, style: class.number(), points }
    }
}

/// What a tile has of one layer, ready to be uploaded: nothing of a method that is not wanted.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TileLayer {
    /// The pieces as geometry (GEO). The place of a road's class is that of the line's style.
    pub segments: RoadSegments,
    /// The pieces as volumes (SV), likewise.
    pub volumes: RoadVolumes,
}

impl TileLayer {
    /// Several layers of one tile as one.
    #[must_use]
    pub fn joined<'a>(layers: impl Iterator<Item = &'a Self> + Clone) -> Self {
        Self {
            segments: RoadSegments::joined(layers.clone().map(|layer| &layer.segments)),
            volumes: RoadVolumes::joined(layers.map(|layer| &layer.volumes)),
        }
    }

    /// Whether there is nothing in it.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.segments.all().is_empty() && self.volumes.all().is_empty()
    }
}

/// What a tile has of all layers.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct LineLayers([TileLayer; LineLayer::ALL.len()]);

impl LineLayers {
    /// One of them.
    #[must_use]
    pub fn of(&self, layer: LineLayer) -> &TileLayer {
        &self.0[layer as usize]
    }

    /// Replaces one of them.
    pub fn set(&mut self, layer: LineLayer, lines: TileLayer) {
        self.0[layer as usize] = lines;
    }
}

/// The methods for which lines are prepared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say what they are")]
pub enum LineMethods {
    Geometry,
    ShadowVolumes,
    Both,
}
