//! What one tile holds of a way, and how it is sorted outside memory.

use corniche_roads::{AttributeParts, FunctionalRoadClass, RoadAttributes};
use corniche_store::{SortRecord, append_record, take_record};
use serde::{Deserialize, Serialize};

use crate::plane::{along, vector};

/// A vertex of a road on its tile's ground.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Vertex {
    /// Steps of the lattice east and north; whole for a source point.
    pub(crate) at: [f64; 2],
    /// Height, metres.
    pub(crate) z_m: f64,
    /// A point of the level's line, or of its cut at the tile's border; else where the line crosses an edge of the ground.
    pub(crate) is_source: bool,
}

impl Vertex {
    /// The place on the way to another vertex.
    pub(crate) fn towards(self, to: Self, share: f64) -> Self {
        let [u, v, z_m] =
            along([self.at[0], self.at[1], self.z_m], [to.at[0], to.at[1], to.z_m], share);
        Self { at: [u, v], z_m, is_source: false }
    }

    /// The height at a place on the way to another vertex.
    pub(crate) fn height_m_at(self, to: Self, at: [f64; 2]) -> f64 {
        let run = vector(self.at, to.at);
        let axis = usize::from(run[1].abs() > run[0].abs());
        let share = (at[axis] - self.at[axis]) / run[axis];
        let share = if share.is_finite() { share } else { 0.0 };
        self.z_m + share * (to.z_m - self.z_m)
    }
}

/// Where a piece comes from; pieces sort by it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) struct PieceKey {
    pub(crate) way_id: i64,
    /// The tile's place in the package.
    pub(crate) tile: u64,
    /// The number of the piece along the way within the tile.
    pub(crate) part: u32,
    /// The number of what the bounds left of the piece.
    pub(crate) cut: u32,
}

/// What one tile holds of a way, in the way's direction.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Piece {
    pub(crate) key: PieceKey,
    pub(crate) class: FunctionalRoadClass,
    pub(crate) attributes: RoadAttributes,
    /// Two at least.
    pub(crate) vertices: Vec<Vertex>,
    /// Whether the line may go on from its first vertex, and from its last, in another tile: they are points on the tile's
    /// border.
    pub(crate) goes_on: [bool; 2],
    pub(crate) heights: PieceHeights,
}

/// How far heights of a piece are from those of the elevation files, at most, metres.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct PieceHeights {
    /// The piece's own heights, over the whole line where it lies on the ground; `None` where nothing of it lies on the files' samples.
    pub(crate) tolerance_m: Option<f64>,
    /// The ground of its tile; `None` where it was not measured.
    pub(crate) ground_m: Option<f64>,
    /// Whether they are those of a deck or a tunnel, which nothing tells how good they are.
    pub(crate) on_deck: bool,
    /// Whether some of them are.
    pub(crate) has_deck: bool,
}

impl PieceHeights {
    /// What holds for two pieces together.
    pub(crate) fn with(self, other: Self) -> Self {
        Self {
            tolerance_m: larger(self.tolerance_m, other.tolerance_m),
            ground_m: larger(self.ground_m, other.ground_m),
            on_deck: self.on_deck && other.on_deck,
            has_deck: self.has_deck || other.has_deck,
        }
    }
}

/// The larger of two numbers; one alone is the larger.
pub(crate) fn larger(one: Option<f64>, other: Option<f64>) -> Option<f64> {
    [one, other].into_iter().flatten().reduce(f64::max)
}

/// No two pieces have the same key.
impl Eq for Piece {}

impl PartialOrd for Piece {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Piece {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.key.cmp(&other.key)
    }
}

impl SortRecord for Piece {
    fn encode(&self, bytes: &mut Vec<u8>) {
        let Piece { key, class, attributes, vertices, goes_on, heights } = self;
        let AttributeParts { codes, width_mm, texts } = attributes.parts();
        let record = (key, class, codes, width_mm, texts, vertices, goes_on, heights);
        append_record(bytes, record);
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        let (key, class, codes, width_mm, texts, vertices, goes_on, heights) = take_record(bytes)?;
        let mut texts = <[String; 7]>::into_iter(texts);
        let attributes = RoadAttributes::from_parts(codes, width_mm, || texts.next())?;
        Some(Self { key, class, attributes, vertices, goes_on, heights })
    }

    fn extra_bytes(&self) -> usize {
        let Piece { attributes, vertices, .. } = self;
        vertices.capacity() * size_of::<Vertex>() + attributes.text_bytes()
    }
}

#[cfg(test)]
#[path = "piece_tests.rs"]
mod tests;
