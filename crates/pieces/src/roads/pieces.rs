//! The pieces of roads that a tile needs: parts of their lines, as the tile's level shows them.

use std::sync::Arc;

use corniche_geom::{LatticePoint, TileId};
use corniche_roads::{FunctionalRoadClass, RoadAttributes};
use corniche_spec::artifacts::{ArtifactError, ArtifactKind, damaged};
use corniche_store::Artifacts;
use corniche_tileset::LayerSlot;
use corniche_varints::{push_signed, push_varint, take_array, take_number, take_signed};

use crate::layers::{
    segment_run::{SegmentRun, take_count},
    span_pieces::{self, SpanLineOf},
};

/// The part of one road that a tile needs.
///
/// ```text
///       ┌───────────────────┐ tile and margin      The line leaves and comes back: two runs. A run has whole
///   ●───┼──●────●           │                      segments, so clipping gives the same parts, at the same points,
///       │        ╲          │                      as clipping the whole line.
///       └─────────●─────────┘
///    run 1         ●        ●     run 2
///                   ╲      ╱
///                    ●────●       (not kept)
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct RoadPiece {
    /// The way of the road.
    pub way_id: i64,
    /// The class of the road.
    pub class: FunctionalRoadClass,
    /// Attributes of the road, shared by all its pieces.
    pub attributes: Arc<RoadAttributes>,
    /// The number of points of the source line that belong to the tile.
    pub(crate) source_points: u64,
    /// The number of points of the level's simplified line that belong to the tile.
    pub(crate) simplified_points: u64,
    /// The runs in the order of the line.
    pub(crate) runs: Vec<SegmentRun>,
}

/// The pieces of all roads of a tile with the roads' ordinals, ascending, and the pieces of layers'
/// lines that may be off its ground.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TilePieces {
    /// Pieces with the numbers of their roads.
    pub roads: Vec<(u32, RoadPiece)>,
    /// Pieces of lines of layers on bridges and in tunnels.
    pub(crate) of_layers: Vec<(SpanLineOf, SegmentRun)>,
}

impl TilePieces {
    /// Reads the pieces of a tile in a build with this number of layers; none if the store has no
    /// artifact.
    ///
    /// # Errors
    /// When an artifact cannot be read or is invalid.
    pub fn load(store: &dyn Artifacts, id: TileId, layers: usize) -> Result<Self, ArtifactError> {
        let key = ArtifactKind::RoadPieces.of_tile(id);
        let mut pieces = match store.get(key)? {
            Some(bytes) => Self::from_bytes(&bytes)
                .ok_or_else(|| damaged(key, &"it does not hold pieces of roads"))?,
            None => Self::default(),
        };
        for slot in (0..layers).map_while(LayerSlot::new) {
            pieces.of_layers.extend(span_pieces::get(store, slot, id)?);
        }
        Ok(pieces)
    }

    /// Whether the tile needs nothing of any road and of any line.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.roads.is_empty() && self.of_layers.is_empty()
    }

    /// Decodes the pieces of roads, one after another; `None` for other bytes.
    #[must_use]
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let mut rest = bytes;
        let mut roads = Vec::new();
        while !rest.is_empty() {
            roads.push((take_number(&mut rest)?, RoadPiece::take(&mut rest)?));
        }
        let ascend = roads.is_sorted_by(|(one, _), (next, _)| one < next);
        ascend.then_some(Self { roads, of_layers: Vec::new() })
    }
}

impl RoadPiece {
    /// Encodes the piece of the road with this number: numbers of variable length, and points as
    /// differences from the previous point.
    pub(crate) fn to_bytes(&self, ordinal: u32) -> Vec<u8> {
        let Self { way_id, class, attributes, source_points, simplified_points, runs } = self;
        let points: usize = runs.iter().map(|run| run.line.points().len()).sum();
        let mut bytes = Vec::with_capacity(64 + points * 12);
        push_varint(&mut bytes, ordinal.into());
        push_signed(&mut bytes, *way_id);
        bytes.push(class.number());
        attributes.push_to(&mut bytes);
        push_varint(&mut bytes, *source_points);
        push_varint(&mut bytes, *simplified_points);
        push_varint(&mut bytes, runs.len() as u64);
        let mut before = LatticePoint::new(0, 0);
        for run in runs {
            run.push_to(&mut bytes, &mut before);
        }
        bytes
    }

    fn take(rest: &mut &[u8]) -> Option<Self> {
        let way_id = take_signed(rest)?;
        let [class] = take_array(rest)?;
        let attributes = Arc::new(RoadAttributes::take_from(rest)?);
        let [source_points, simplified_points] = [take_number(rest)?, take_number(rest)?];
        let count = take_count(rest)?;
        let mut before = LatticePoint::new(0, 0);
        let mut runs = Vec::with_capacity(count);
        for _ in 0..count {
            runs.push(SegmentRun::take(rest, &mut before)?);
        }
        let class = FunctionalRoadClass::new(class)?;
        Some(Self { way_id, class, attributes, source_points, simplified_points, runs })
    }
}

#[cfg(test)]
#[path = "pieces_tests.rs"]
mod tests;
