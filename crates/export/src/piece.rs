//! A piece: a stretch of a way in one tile, and its form for sorting outside memory.

use corniche_roads::{AttributeParts, FunctionalRoadClass, RoadAttributes};
use corniche_store::{SortRecord, append_record, take_record};
use serde::{Deserialize, Serialize};

use crate::plane::{along, vector};

/// A vertex of a road on its tile's ground.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Vertex {
    /// Lattice steps east and north; whole for a source point.
    pub(crate) at: [f64; 2],
    /// Height, metres.
    pub(crate) z_m: f64,
    /// Whether this is a point of the level's line, or of its cut at the tile's border; otherwise
    /// the line crosses a triangle edge of the ground here.
    pub(crate) is_source: bool,
}

impl Vertex {
    /// Returns the place at a share of the way to another vertex.
    pub(crate) fn towards(self, to: Self, share: f64) -> Self {
        let [u, v, z_m] =
            along([self.at[0], self.at[1], self.z_m], [to.at[0], to.at[1], to.z_m], share);
        Self { at: [u, v], z_m, is_source: false }
    }

    /// Returns the height at a place on the way to another vertex.
    pub(crate) fn height_m_at(self, to: Self, at: [f64; 2]) -> f64 {
        let run = vector(self.at, to.at);
        let axis = usize::from(run[1].abs() > run[0].abs());
        let share = (at[axis] - self.at[axis]) / run[axis];
        let share = if share.is_finite() { share } else { 0.0 };
        self.z_m + share * (to.z_m - self.z_m)
    }
}

/// Returns the vertices of a line that are source points or its ends, with their indices.
pub(crate) fn own_points(line: &[Vertex]) -> impl Iterator<Item = (usize, &Vertex)> {
    let last = line.len().saturating_sub(1);
    let is_kept = move |index: usize| line[index].is_source || index == 0 || index == last;
    line.iter().enumerate().filter(move |(index, _)| is_kept(*index))
}

/// The origin of a piece, which is its sorting key.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) struct PieceKey {
    pub(crate) way_id: i64,
    /// The tile's position in the order of the package.
    pub(crate) tile: u64,
    /// The number of the piece along the way within the tile.
    pub(crate) part: u32,
    /// The number of the part of the piece inside the bounds.
    pub(crate) cut: u32,
}

/// A stretch of a way in one tile, in the way's direction.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct WayPiece {
    pub(crate) key: PieceKey,
    pub(crate) class: FunctionalRoadClass,
    pub(crate) attributes: RoadAttributes,
    /// At least two vertices.
    pub(crate) vertices: Vec<Vertex>,
    /// Whether the line may continue in another tile from its first vertex, and from its last: they
    /// are points on the tile's border.
    pub(crate) goes_on: [bool; 2],
    pub(crate) heights: PieceHeights,
}

impl WayPiece {
    /// Returns a part of the piece. `has_end` is whether its first vertex is the first of the
    /// piece, and its last the last: new ends do not continue in other tiles.
    pub(crate) fn part(&self, cut: u32, vertices: Vec<Vertex>, has_end: [bool; 2]) -> Self {
        let goes_on = [0, 1].map(|end| has_end[end] && self.goes_on[end]);
        Self { key: PieceKey { cut, ..self.key }, vertices, goes_on, ..self.clone() }
    }
}

/// The largest distances of a piece's heights from those of the elevation files, metres.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct PieceHeights {
    /// The distance of the piece's own heights, over the whole line where it is on the ground;
    /// `None` if no part of it is on the files' samples.
    pub(crate) tolerance_m: Option<f64>,
    /// The distance of its tile's triangles; `None` if it was not measured.
    pub(crate) ground_m: Option<f64>,
    /// Whether the heights are those of a deck or a tunnel, whose accuracy is unknown.
    pub(crate) on_deck: bool,
    /// Whether some of the heights are those of a deck or a tunnel.
    pub(crate) has_deck: bool,
}

impl PieceHeights {
    /// Returns the heights of two pieces together.
    pub(crate) fn with(self, other: Self) -> Self {
        Self {
            tolerance_m: larger(self.tolerance_m, other.tolerance_m),
            ground_m: larger(self.ground_m, other.ground_m),
            on_deck: self.on_deck && other.on_deck,
            has_deck: self.has_deck || other.has_deck,
        }
    }
}

/// Returns the larger of two numbers, or the only one.
pub(crate) fn larger(one: Option<f64>, other: Option<f64>) -> Option<f64> {
    [one, other].into_iter().flatten().reduce(f64::max)
}

/// No two pieces have the same key.
impl Eq for WayPiece {}

impl PartialOrd for WayPiece {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for WayPiece {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.key.cmp(&other.key)
    }
}

impl SortRecord for WayPiece {
    fn encode(&self, bytes: &mut Vec<u8>) {
        let WayPiece { key, class, attributes, vertices, goes_on, heights } = self;
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
        let WayPiece { attributes, vertices, .. } = self;
        vertices.capacity() * size_of::<Vertex>() + attributes.text_bytes()
    }
}

#[cfg(test)]
#[path = "piece_tests.rs"]
mod tests;
