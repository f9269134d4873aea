//! Lines that are not roads: boundaries, and lines from users' files. They are drawn like roads, by
//! both methods, over the roads.
//!
//! A package stores such lines in plan, or not at all. Their position on the ground, and the
//! heights of the ground next to them, are computed when a tile is read, with the clipper that also
//! builds packages: each line is cut at every edge of the tile's triangles, by exact decisions on
//! the lattice.

mod dashes;
mod lay;
mod overlays;

use corniche_geom::{Bounds, LatticePoint, StepBudget};
use corniche_tileset::LineRecord;
use serde::{Deserialize, Serialize};

pub use self::{lay::TileSurface, overlays::Overlays};
use super::{
    InNet, OffGroundRoads, RoadSegments, RoadVolumes, TileLines, relief::RoadRelief,
    roads::GroundNet,
};
use crate::options::Mapping;

/// The layers of lines, from the lowest to the highest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LineLayer {
    /// Boundaries of the package.
    Boundaries,
    /// Lines from users' files.
    Overlays,
    /// Lines that the user draws in the window.
    Drawn,
}

impl LineLayer {
    /// All layers, in the order in which they are drawn.
    pub const ALL: [Self; 3] = [Self::Boundaries, Self::Overlays, Self::Drawn];
}

/// A line in plan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LayerLine {
    /// Lines with the same id are parts of one line: the OSM id of the way, or the number of a line
    /// in a file.
    pub id: i64,
    /// The style of the layer in which the line is drawn, below
    /// [`LineStyle::MOST`](corniche_styles::LineStyle::MOST).
    pub style: u8,
    /// The points of the line, at least two.
    pub points: Vec<LatticePoint>,
}

impl From<LineRecord> for LayerLine {
    fn from(LineRecord { way_id, class, points }: LineRecord) -> Self {
        Self { id: way_id, style: class.number(), points }
    }
}

/// The lines of one layer of a tile, ready to be uploaded; only for the requested methods.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TileLayer {
    /// The pieces as geometry (GEO). The line's style replaces the road class.
    pub segments: RoadSegments,
    /// The pieces as volumes (SV). The line's style replaces the road class.
    pub volumes: RoadVolumes,
}

impl TileLayer {
    /// Drapes the lines of a tile on its ground, and returns them with the network that they form.
    /// Unmapped lines are not draped.
    pub(crate) fn of_lines(
        lines: &TileLines,
        relief: &RoadRelief<'_>,
        (tile, reference_m): (Bounds, [f64; 3]),
        work: &StepBudget,
    ) -> (Self, GroundNet) {
        let decks = OffGroundRoads::new(lines, tile, work);
        let (on_ground, net) = InNet::all_of(&lines.ground, &decks, 0.0);
        let (in_plan, net_in_plan) = InNet::all_of(&lines.plan, &decks, lines.width_margin_m);
        let net = if lines.ground.is_empty() { net_in_plan } else { net };
        if lines.mapping == Mapping::Unmapped {
            return (Self::default(), net);
        }
        let (wide, scale) = (relief.wide(&lines.ground), &lines.scale);
        let bed = |piece: &_| relief.bed(piece, wide.as_ref());
        let segments = RoadSegments::of_lines(&on_ground, &decks, reference_m, scale, bed);
        let near = |ends_m| relief.near(ends_m);
        let volumes = RoadVolumes::new(&in_plan, &decks, reference_m, scale, near);
        (Self { segments, volumes }, net)
    }

    /// Merges several layers of one tile.
    #[must_use]
    pub fn joined<'a>(layers: impl Iterator<Item = &'a Self> + Clone) -> Self {
        Self {
            segments: RoadSegments::joined(layers.clone().map(|layer| &layer.segments)),
            volumes: RoadVolumes::joined(layers.map(|layer| &layer.volumes)),
        }
    }

    /// Whether the layer has no lines.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.segments.all().is_empty() && self.volumes.all().is_empty()
    }
}

/// The lines of all layers of a tile.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct LineLayers([TileLayer; LineLayer::ALL.len()]);

impl LineLayers {
    /// Returns one layer.
    #[must_use]
    pub fn tile_layer(&self, layer: LineLayer) -> &TileLayer {
        &self.0[layer as usize]
    }

    /// Replaces one layer.
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
