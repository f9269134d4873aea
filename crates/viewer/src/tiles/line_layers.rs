//! Lines that are not roads: lines of layers, and lines from users' files. They are drawn like
//! roads, by both methods, over the roads.
//!
//! A package stores such lines in plan, or not at all. Their position on the ground, and the
//! heights of the ground next to them, are computed when a tile is read, with the clipper that also
//! builds packages: each line is cut at every edge of the tile's triangles, by exact decisions on
//! the lattice.

mod dashes;
mod lay;
mod overlays;

use std::collections::BTreeMap;

use corniche_geom::{Bounds, LatticePoint, StepBudget};
use serde::{Deserialize, Serialize};

pub use self::{lay::TileSurface, overlays::Overlays};
use super::{
    DeckPieces, InNet, OffGroundRoads, RoadSegments, RoadVolumes, TileLines, relief::RoadRelief,
    roads::GroundNet,
};
use crate::{line_places::LineLayer, options::Mapping};

/// A line in plan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StyledLine {
    /// Lines with the same id are parts of one line: the OSM id of the way, or the number of a line
    /// in a file.
    pub id: i64,
    /// The style of the layer in which the line is drawn, below
    /// [`LineStyle::MOST`](corniche_styles::LineStyle::MOST).
    pub style: u8,
    /// The points of the line, at least two.
    pub points: Vec<LatticePoint>,
}

/// The roads of a tile, or its lines of one layer, ready to be uploaded; only for the requested
/// methods.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TileLayer {
    /// The pieces as geometry (GEO). The style of a line replaces the road class.
    pub segments: RoadSegments,
    /// The pieces as volumes (SV), likewise.
    pub volumes: RoadVolumes,
    /// The pieces of decks of bridges, for both methods.
    pub decks: DeckPieces,
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
        let TileLines { scale, .. } = lines;
        let decks = OffGroundRoads::new(lines, tile, work);
        let (on_ground, net) = InNet::all_of(&lines.ground, &decks, 0.0);
        let (in_plan, net_in_plan) = InNet::all_of(&lines.plan, &decks, lines.width_margin_m);
        let net = if lines.ground.is_empty() { net_in_plan } else { net };
        if lines.mapping == Mapping::Unmapped {
            return (Self::default(), net);
        }
        let wide = relief.wide(&lines.ground);
        let bed = |piece: &_| relief.bed(piece, wide.as_ref());
        let segments = RoadSegments::of_lines(&on_ground, &decks, reference_m, scale, bed);
        let near = |ends_m| relief.near(ends_m);
        let volumes = RoadVolumes::new(&in_plan, &decks, reference_m, scale, near);
        let decks = DeckPieces::of_decks(&lines.decks, &net, (tile, reference_m), scale, work);
        (Self { segments, volumes, decks }, net)
    }

    /// Merges several layers of one tile.
    #[must_use]
    pub fn joined<'a>(layers: impl Iterator<Item = &'a Self> + Clone) -> Self {
        Self {
            segments: RoadSegments::joined(layers.clone().map(|layer| &layer.segments)),
            volumes: RoadVolumes::joined(layers.clone().map(|layer| &layer.volumes)),
            decks: DeckPieces::joined(layers.map(|layer| &layer.decks)),
        }
    }

    /// Whether the layer has no lines.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        let Self { segments, volumes, decks } = self;
        segments.all().is_empty() && volumes.all().is_empty() && decks.all().is_empty()
    }
}

/// The lines of all layers of a tile.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct LineLayers(pub(crate) BTreeMap<LineLayer, TileLayer>);

impl LineLayers {
    /// Returns the lines that are drawn at once; `None` without lines.
    #[must_use]
    pub fn tile_layer(&self, layer: LineLayer) -> Option<&TileLayer> {
        self.0.get(&layer)
    }

    /// Adds lines to those that are drawn at once.
    pub fn add(&mut self, layer: LineLayer, lines: TileLayer) {
        if lines.is_empty() {
            return;
        }
        let all = match self.0.get(&layer) {
            Some(known) => TileLayer::joined([known, &lines].into_iter()),
            None => lines,
        };
        self.0.insert(layer, all);
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
