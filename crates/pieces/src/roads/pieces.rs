//! What a tile needs of its roads: pieces of their lines as its level shows them.

use std::sync::Arc;

use corniche_geom::{LatticePoint, Polyline, TileId};
use corniche_roads::{AttributeParts, FunctionalRoadClass, RoadAttributes};
use corniche_spec::artifacts::{ArtifactError, Kind, damaged};
use corniche_store::Artifacts;
use corniche_varints::{
    push_bytes, push_signed, push_varint, take_array, take_number, take_signed, take_text,
};

/// What a tile needs of one road.
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
    /// All pieces of a road have the same.
    pub attributes: Arc<RoadAttributes>,
    /// How many points of the source line belong to the tile.
    pub(crate) source_points: u64,
    /// The same of the level's simplified line.
    pub(crate) simplified_points: u64,
    /// The runs in the order of the line.
    pub(crate) runs: Vec<Run>,
}

/// Segments of the level's line that follow each other and may meet the tile or its margin.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Run {
    pub line: Polyline,
    /// The true length of each segment in micrometres on the finest level, and of bridges and tunnels, where spans are wanted, on all; of what is
    /// simplified it is that of the source line. Else empty.
    pub(crate) segments_um: Vec<u64>,
    /// How far along the road it begins, micrometres; 0 where lengths are not known.
    pub(crate) from_um: u64,
    /// The nodes at which other roads may join, on the finest level where spans are wanted: which points they are, and their ids.
    pub nodes: Vec<(u32, i64)>,
}

/// The pieces of all roads of a tile with the roads' ordinals, ascending.
///
/// Bytes: for each road, how many ordinals lie between it and the road before, and then its piece.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TilePieces {
    /// Pieces with the numbers of their roads.
    pub roads: Vec<(u32, RoadPiece)>,
}

impl TilePieces {
    /// The pieces of a tile; none if nothing is in the store.
    ///
    /// # Errors
    /// When it cannot be kept or read, or makes no sense.
    pub fn load(store: &dyn Artifacts, id: TileId) -> Result<Self, ArtifactError> {
        let key = Kind::RoadPieces.of_tile(id);
        let Some(bytes) = store.get(key)? else { return Ok(Self::default()) };
        Self::from_bytes(&bytes).ok_or_else(|| damaged(key, &"these are no pieces of roads"))
    }

    /// Reads what `TilePiecesWriter` made; `None` for other bytes.
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

/// Puts the pieces of a tile one after the other.
#[derive(Default)]
pub(crate) struct TilePiecesWriter {
    bytes: Vec<u8>,
    /// The least ordinal that can follow.
    next: u32,
}

impl TilePiecesWriter {
    /// Adds a road by its encoded piece. Ordinals ascend.
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
    /// Its bytes: numbers of variable length, points as differences from the point before.
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        let Self { way_id, class, attributes, source_points, simplified_points, runs } = self;
        let points: usize = runs.iter().map(|run| run.line.points().len()).sum();
        let mut bytes = Vec::with_capacity(64 + points * 12);
        push_signed(&mut bytes, *way_id);
        bytes.push(class.number());
        put_attributes(&mut bytes, attributes);
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
        let attributes = Arc::new(take_attributes(rest)?);
        let [source_points, simplified_points] = [take_number(rest)?, take_number(rest)?];
        let count = take_count(rest)?;
        let mut before = LatticePoint::new(0, 0);
        let mut runs = Vec::with_capacity(count);
        for _ in 0..count {
            runs.push(Run::take(rest, &mut before)?);
        }
        let class = FunctionalRoadClass::new(class)?;
        Some(Self { way_id, class, attributes, source_points, simplified_points, runs })
    }
}

fn put_attributes(bytes: &mut Vec<u8>, attributes: &RoadAttributes) {
    let AttributeParts { codes, width_mm, texts } = attributes.parts();
    bytes.extend(codes);
    push_varint(bytes, width_mm.into());
    for text in texts {
        push_bytes(bytes, text.as_bytes());
    }
}

fn take_attributes(rest: &mut &[u8]) -> Option<RoadAttributes> {
    let codes = take_array(rest)?;
    let width_mm = take_number(rest)?;
    RoadAttributes::from_parts(codes, width_mm, || take_text(rest).map(str::to_owned))
}

/// How many things follow that take a byte each at least: never more than there are bytes.
fn take_count(rest: &mut &[u8]) -> Option<usize> {
    take_number(rest).filter(|count| *count <= rest.len())
}

impl Run {
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
        // Equal neighbours would have been merged: a run has none.
        let is_whole = line.points().len() == count && (lengths == 0 || lengths == count - 1);
        is_whole.then_some(Self { line, segments_um, from_um, nodes })
    }
}

#[cfg(test)]
#[path = "pieces_tests.rs"]
mod tests;
