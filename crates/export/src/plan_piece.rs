//! A piece of an object without heights (an area or a boundary): what one tile has of it, and its
//! form for sorting outside memory.

use corniche_areas::AreaObject;
use corniche_geom::LatticePoint;
use corniche_store::SerdeRecord;
use serde::{Deserialize, Serialize};

use crate::error::FeaturesError;

/// What one tile has of an object: rings of an area in any order, or some segments of a line.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) struct PlanPiece {
    pub(crate) object: AreaObject,
    /// The tile's position in the order of the package.
    pub(crate) tile: u64,
    /// The number of its class.
    pub(crate) class: u8,
    /// The name; empty for none.
    pub(crate) name: String,
    pub(crate) lines: Vec<Vec<LatticePoint>>,
}

/// The lines of all pieces.
pub(crate) fn lines_of(pieces: &[PlanPiece]) -> impl Iterator<Item = &[LatticePoint]> + Clone {
    pieces.iter().flat_map(|piece| piece.lines.iter().map(Vec::as_slice))
}

/// Returns the class of an object, which all its pieces share, as they share its name; `class`
/// converts the number.
pub(crate) fn class_of<C>(
    pieces: &[PlanPiece],
    class: impl Fn(u8) -> Option<C>,
) -> Result<C, FeaturesError> {
    let first = &pieces[0];
    let is_same = |piece: &PlanPiece| (piece.class, &piece.name) == (first.class, &first.name);
    let class = class(first.class).filter(|_| pieces.iter().all(is_same));
    class.ok_or(FeaturesError::Differs { object: first.object })
}

impl SerdeRecord for PlanPiece {
    fn extra_bytes(&self) -> usize {
        let points: usize = self.lines.iter().map(Vec::capacity).sum();
        points * size_of::<LatticePoint>()
            + self.lines.capacity() * size_of::<Vec<LatticePoint>>()
            + self.name.capacity()
    }
}

#[cfg(test)]
#[path = "plan_piece_tests.rs"]
mod tests;
