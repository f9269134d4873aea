//! A piece of an object of a layer: what one tile has of it, laid on the tile's ground, and its
//! form for sorting outside memory.

use std::cmp::Ordering;

use corniche_geom::LatticePoint;
use corniche_layers::{AttributeValue, OsmObject};
use corniche_store::SerdeRecord;
use corniche_tileset::{LayerObject, LayerShape};
use serde::{Deserialize, Serialize};

use crate::{
    error::FeaturesError,
    laid_lines::{LaidStretch, parts_on_ground},
    piece::Vertex,
    whole_lines::whole_lines,
};

/// What one tile has of an object.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct LayerPiece {
    /// The tile's position in the order of the package.
    pub(crate) tile: u64,
    /// The number of the piece in the tile.
    pub(crate) part: usize,
    /// The object, or the part of it in the tile.
    pub(crate) of: LayerObject,
    /// The stretches of a line on the tile's ground, or its point at the height of the ground.
    pub(crate) laid: Vec<LaidStretch>,
}

impl LayerPiece {
    /// The points of a line; none of other shapes.
    fn line(&self) -> &[LatticePoint] {
        if let LayerShape::Line(points) = &self.of.shape { points } else { &[] }
    }

    fn key(&self) -> (OsmObject, u64, usize) {
        (self.of.object, self.tile, self.part)
    }
}

/// Checks that all pieces of an object have the same class and the same values.
pub(crate) fn check_same(pieces: &[LayerPiece]) -> Result<&LayerObject, FeaturesError> {
    let first = &pieces[0].of;
    let is_same =
        |piece: &LayerPiece| piece.of.class == first.class && piece.of.values == first.values;
    let differs = || FeaturesError::Differs { object: first.object };
    pieces.iter().all(is_same).then_some(first).ok_or_else(differs)
}

/// Returns the point of an object as a line of one vertex; none without ground.
pub(crate) fn point_of(pieces: &[LayerPiece]) -> Vec<Vec<Vertex>> {
    let laid = pieces.iter().flat_map(|piece| &piece.laid);
    laid.take(1).map(|laid| laid.vertices.clone()).collect()
}

/// Returns the lines of an object on the ground, from all its pieces, each segment once.
pub(crate) fn lines_of(pieces: &[LayerPiece]) -> Vec<Vec<Vertex>> {
    let lines = whole_lines(&pieces.iter().map(LayerPiece::line));
    parts_on_ground(&lines, pieces.iter().flat_map(|piece| &piece.laid)).concat()
}

/// No two pieces have the same key.
impl Eq for LayerPiece {}

impl PartialOrd for LayerPiece {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for LayerPiece {
    fn cmp(&self, other: &Self) -> Ordering {
        self.key().cmp(&other.key())
    }
}

impl SerdeRecord for LayerPiece {
    fn extra_bytes(&self) -> usize {
        let text = |value: &AttributeValue| match value {
            AttributeValue::Text(text) => text.capacity(),
            AttributeValue::Names(names) => names
                .iter()
                .map(|(language, name)| language.len() + name.len() + size_of::<[String; 2]>())
                .sum(),
            _ => 0,
        };
        let Self { of: LayerObject { values, shape, .. }, laid, .. } = self;
        let vertices: usize = laid.iter().map(|stretch| stretch.vertices.len()).sum();
        values.len() * size_of::<Option<AttributeValue>>()
            + values.iter().flatten().map(text).sum::<usize>()
            + shape.points().count() * size_of::<LatticePoint>()
            + shape.rings().count() * size_of::<Vec<LatticePoint>>()
            + laid.len() * size_of::<LaidStretch>()
            + vertices * size_of::<Vertex>()
    }
}

#[cfg(test)]
#[path = "layer_piece_tests.rs"]
mod tests;
