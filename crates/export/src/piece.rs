//! What one tile holds of a way, and how it is sorted outside memory.

use corniche_roads::{AttributeParts, FunctionalRoadClass, RoadAttributes};
use corniche_store::SortRecord;

/// A vertex of a road on its tile's ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Vertex {
    /// Steps of the lattice east and north; whole for a source point.
    pub(crate) at: [f64; 2],
    /// Height, metres.
    pub(crate) z_m: f64,
    /// A point of the level's line, or of its cut at the tile's border; else where the line crosses an edge of the ground.
    pub(crate) is_source: bool,
}

/// Where a piece comes from; pieces sort by it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
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
#[derive(Debug, Clone, Copy, PartialEq)]
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
        let most = |one: Option<f64>, other: Option<f64>| {
            [one, other].into_iter().flatten().reduce(f64::max)
        };
        Self {
            tolerance_m: most(self.tolerance_m, other.tolerance_m),
            ground_m: most(self.ground_m, other.ground_m),
            on_deck: self.on_deck && other.on_deck,
            has_deck: self.has_deck || other.has_deck,
        }
    }
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

const VERTEX_BYTES: usize = 25;

impl SortRecord for Piece {
    /// Numbers in little-endian order; a text has its length before it; vertices come last.
    fn encode(&self, bytes: &mut Vec<u8>) {
        let Piece { key, class, attributes, vertices, goes_on, heights } = self;
        let AttributeParts { codes, width_mm, texts } = attributes.parts();
        bytes.extend(key.way_id.to_le_bytes());
        bytes.extend(key.tile.to_le_bytes());
        bytes.extend(key.part.to_le_bytes());
        bytes.extend(key.cut.to_le_bytes());
        let [first, last] = *goes_on;
        bytes.push(class.number());
        bytes.extend([first, last, heights.on_deck, heights.has_deck].map(u8::from));
        for number in [heights.tolerance_m, heights.ground_m] {
            bytes.extend(number.unwrap_or(f64::NAN).to_le_bytes());
        }
        bytes.extend(codes);
        bytes.extend(width_mm.to_le_bytes());
        for text in texts {
            bytes.extend((text.len() as u64).to_le_bytes());
            bytes.extend(text.as_bytes());
        }
        bytes.reserve(vertices.len() * VERTEX_BYTES);
        for vertex in vertices {
            for number in [vertex.at[0], vertex.at[1], vertex.z_m] {
                bytes.extend(number.to_le_bytes());
            }
            bytes.push(u8::from(vertex.is_source));
        }
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        let key = PieceKey {
            way_id: i64::from_le_bytes(array(bytes)?),
            tile: u64::from_le_bytes(array(bytes)?),
            part: u32::from_le_bytes(array(bytes)?),
            cut: u32::from_le_bytes(array(bytes)?),
        };
        let [class, first, last, on_deck, has_deck] = array(bytes)?;
        let known = |number: f64| Some(number).filter(|number| !number.is_nan());
        let [tolerance_m, ground_m] = [number(bytes)?, number(bytes)?].map(known);
        let (on_deck, has_deck) = (on_deck == 1, has_deck == 1);
        let heights = PieceHeights { tolerance_m, ground_m, on_deck, has_deck };
        let (codes, width_mm) = (array(bytes)?, u32::from_le_bytes(array(bytes)?));
        let attributes = RoadAttributes::from_parts(codes, width_mm, || text(bytes))?;
        let mut vertices = Vec::with_capacity(bytes.len() / VERTEX_BYTES);
        while !bytes.is_empty() {
            let [u, v, z_m] = [number(bytes)?, number(bytes)?, number(bytes)?];
            let [is_source] = array(bytes)?;
            vertices.push(Vertex { at: [u, v], z_m, is_source: is_source == 1 });
        }
        let class = FunctionalRoadClass::new(class)?;
        let goes_on = [first == 1, last == 1];
        Some(Self { key, class, attributes, vertices, goes_on, heights })
    }

    fn extra_bytes(&self) -> usize {
        let Piece { attributes, vertices, .. } = self;
        vertices.capacity() * size_of::<Vertex>() + attributes.text_bytes()
    }
}

pub(crate) fn array<const N: usize>(bytes: &mut &[u8]) -> Option<[u8; N]> {
    let (head, rest) = bytes.split_first_chunk()?;
    *bytes = rest;
    Some(*head)
}

fn number(bytes: &mut &[u8]) -> Option<f64> {
    array(bytes).map(f64::from_le_bytes)
}

pub(crate) fn text(bytes: &mut &[u8]) -> Option<String> {
    let length = usize::try_from(u64::from_le_bytes(array(bytes)?)).ok()?;
    let (text, rest) = bytes.split_at_checked(length)?;
    *bytes = rest;
    String::from_utf8(text.to_vec()).ok()
}

#[cfg(test)]
#[path = "piece_tests.rs"]
mod tests;
