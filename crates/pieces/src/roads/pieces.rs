//! The pieces of roads that a tile needs: parts of their lines, as the tile's level shows them.

use std::sync::Arc;

use corniche_geom::{LatticePoint, Polyline, TileId};
use corniche_roads::{FunctionalRoadClass, RoadAttributes};
use corniche_spec::artifacts::{ArtifactError, ArtifactKind, damaged};
use corniche_store::Artifacts;
use corniche_varints::{push_signed, push_varint, take_array, take_number, take_signed};

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

/// Consecutive segments of the level's line that may touch the tile or its margin.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SegmentRun {
    pub line: Polyline,
    /// The true length of each segment in micrometres: on the finest level, and for bridges and
    /// tunnels on all levels if spans are requested. Simplified segments have the length of the
    /// source line. Otherwise empty.
    pub(crate) segments_um: Vec<u64>,
    /// Distance of its start along the road, micrometres; 0 if lengths are not known.
    pub(crate) from_um: u64,
    /// The nodes at which other roads may join: the indices of their points, and their ids. Only on
    /// the finest level and if spans are requested.
    pub nodes: Vec<(u32, i64)>,
}

/// The pieces of all roads of a tile with the roads' ordinals, ascending.
///
/// Encoding: for each road, the number of ordinals skipped since the road before, and then its
/// piece.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TilePieces {
    /// Pieces with the numbers of their roads.
    pub roads: Vec<(u32, RoadPiece)>,
}

impl TilePieces {
    /// Reads the pieces of a tile; none if the store has no artifact.
    ///
    /// # Errors
    /// When the artifact cannot be read or is invalid.
    pub fn load(store: &dyn Artifacts, id: TileId) -> Result<Self, ArtifactError> {
        let key = ArtifactKind::RoadPieces.of_tile(id);
        let Some(bytes) = store.get(key)? else { return Ok(Self::default()) };
        Self::from_bytes(&bytes).ok_or_else(|| damaged(key, &"it does not hold pieces of roads"))
    }

    /// Decodes the bytes of a `TilePiecesWriter`; `None` for other bytes.
    #[must_use]
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let mut rest = bytes;
        let mut roads = Vec::new();
        let mut next = 0_u32;
        while !rest.is_empty() {
            let ordinal = next.checked_add(take_number(&mut rest)?)?;
            roads.push((ordinal, RoadPiece::take(&mut rest)?));
            next = ordinal.checked_add(1)?;
        }
        Some(Self { roads })
    }
}

/// Concatenates the pieces of a tile.
#[derive(Default)]
pub(crate) struct TilePiecesWriter {
    bytes: Vec<u8>,
    /// The smallest ordinal that can follow.
    next: u32,
}

impl TilePiecesWriter {
    /// Adds a road with its encoded piece. Ordinals must ascend.
    pub(crate) fn push(&mut self, ordinal: u32, piece: &[u8]) {
        debug_assert!(ordinal >= self.next, "ordinals ascend");
        push_varint(&mut self.bytes, u64::from(ordinal - self.next));
        self.bytes.extend(piece);
        self.next = ordinal + 1;
    }

    pub(crate) fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }
}

impl RoadPiece {
    /// Encodes the piece: numbers of variable length, and points as differences from the previous
    /// point.
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        let Self { way_id, class, attributes, source_points, simplified_points, runs } = self;
        let points: usize = runs.iter().map(|run| run.line.points().len()).sum();
        let mut bytes = Vec::with_capacity(64 + points * 12);
        push_signed(&mut bytes, *way_id);
        bytes.push(class.number());
        attributes.push_to(&mut bytes);
        push_varint(&mut bytes, *source_points);
        push_varint(&mut bytes, *simplified_points);
        push_varint(&mut bytes, runs.len() as u64);
        let mut before = LatticePoint::new(0, 0);
        for run in runs {
            let points = run.line.points();
            push_varint(&mut bytes, points.len() as u64);
            for &point in points {
                push_signed(&mut bytes, point.u.wrapping_sub(before.u));
                push_signed(&mut bytes, point.v.wrapping_sub(before.v));
                before = point;
            }
            push_varint(&mut bytes, run.segments_um.len() as u64);
            for &segment_um in &run.segments_um {
                push_varint(&mut bytes, segment_um);
            }
            push_varint(&mut bytes, run.from_um);
            push_varint(&mut bytes, run.nodes.len() as u64);
            for &(index, node_id) in &run.nodes {
                push_varint(&mut bytes, index.into());
                push_signed(&mut bytes, node_id);
            }
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

/// Reads the number of items that follow, each at least a byte long: never more than there are
/// bytes.
fn take_count(rest: &mut &[u8]) -> Option<usize> {
    take_number(rest).filter(|count| *count <= rest.len())
}

impl SegmentRun {
    fn take(rest: &mut &[u8], before: &mut LatticePoint) -> Option<Self> {
        let count = take_count(rest)?;
        let mut points = Vec::with_capacity(count);
        for _ in 0..count {
            let [u, v] = [take_signed(rest)?, take_signed(rest)?];
            *before = LatticePoint::new(before.u.wrapping_add(u), before.v.wrapping_add(v));
            points.push(*before);
        }
        let lengths = take_count(rest)?;
        let mut segments_um = Vec::with_capacity(lengths);
        for _ in 0..lengths {
            segments_um.push(take_number(rest)?);
        }
        let from_um = take_number(rest)?;
        let of_nodes = take_count(rest)?;
        let mut nodes = Vec::with_capacity(of_nodes);
        for _ in 0..of_nodes {
            nodes.push((take_number(rest)?, take_signed(rest)?));
        }
        let mut lengths_um = segments_um.iter();
        lengths_um.try_fold(from_um, |sum: u64, length_um| sum.checked_add(*length_um))?;
        let line = Polyline::new(points).ok()?;
        // Equal neighbours would have been merged, so a run has none.
        let is_whole = line.points().len() == count && (lengths == 0 || lengths == count - 1);
        is_whole.then_some(Self { line, segments_um, from_um, nodes })
    }
}

#[cfg(test)]
#[path = "pieces_tests.rs"]
mod tests;
