//! What one tile holds of an object in plan, an area or a boundary, and how it is sorted outside memory.

use corniche_areas::AreaObject;
use corniche_geom::LatticePoint;
use corniche_store::SortRecord;

use crate::{
    error::FeaturesError,
    piece::{array, text},
};

/// What one tile holds of an object: rings of an area in any order, or a part of a line.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct PlanPiece {
    pub(crate) object: AreaObject,
    /// The tile's place in the package.
    pub(crate) tile: u64,
    /// The number of its class.
    pub(crate) class: u8,
    /// Empty for none.
    pub(crate) name: String,
    pub(crate) lines: Vec<Vec<LatticePoint>>,
}

/// The lines of all pieces.
pub(crate) fn lines_of(pieces: &[PlanPiece]) -> impl Iterator<Item = &[LatticePoint]> + Clone {
    pieces.iter().flat_map(|piece| piece.lines.iter().map(Vec::as_slice))
}

/// The class of an object, which all its pieces have, as they have its name; `class` is that of a number.
pub(crate) fn class_of<C>(
    pieces: &[PlanPiece],
    class: impl Fn(u8) -> Option<C>,
) -> Result<C, FeaturesError> {
    let first = &pieces[0];
    let is_same = |piece: &PlanPiece| (piece.class, &piece.name) == (first.class, &first.name);
    let class = class(first.class).filter(|_| pieces.iter().all(is_same));
    class.ok_or(FeaturesError::Differs { object: first.object })
}

impl SortRecord for PlanPiece {
    /// Numbers in little-endian order; the name has its length before it, and so has each line.
    fn encode(&self, bytes: &mut Vec<u8>) {
        let (kind, id) = match self.object {
            AreaObject::Way(id) => (0_u8, id),
            AreaObject::Relation(id) => (1, id),
        };
        bytes.extend([kind, self.class]);
        bytes.extend(id.to_le_bytes());
        bytes.extend(self.tile.to_le_bytes());
        bytes.extend((self.name.len() as u64).to_le_bytes());
        bytes.extend(self.name.as_bytes());
        for line in &self.lines {
            bytes.extend((line.len() as u64).to_le_bytes());
            for point in line {
                bytes.extend(point.u.to_le_bytes());
                bytes.extend(point.v.to_le_bytes());
            }
        }
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        let [kind, class] = array(bytes)?;
        let id = i64::from_le_bytes(array(bytes)?);
        let object = match kind {
            0 => AreaObject::Way(id),
            1 => AreaObject::Relation(id),
            _ => return None,
        };
        let tile = u64::from_le_bytes(array(bytes)?);
        let name = text(bytes)?;
        let mut lines = Vec::new();
        while !bytes.is_empty() {
            let count = usize::try_from(u64::from_le_bytes(array(bytes)?)).ok()?;
            if count > bytes.len() {
                return None;
            }
            let mut line = Vec::with_capacity(count);
            for _ in 0..count {
                let u = i64::from_le_bytes(array(bytes)?);
                line.push(LatticePoint { u, v: i64::from_le_bytes(array(bytes)?) });
            }
            lines.push(line);
        }
        Some(Self { object, tile, class, name, lines })
    }

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
