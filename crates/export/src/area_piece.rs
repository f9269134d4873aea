//! What one tile holds of an area, and how it is sorted outside memory.

use corniche_areas::{AreaClass, AreaObject};
use corniche_geom::LatticePoint;
use corniche_store::SortRecord;

use crate::piece::{array, text};

/// What one tile holds of an area: all its rings there, in any order.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct AreaPiece {
    pub(crate) object: AreaObject,
    /// The tile's place in the package.
    pub(crate) tile: u64,
    pub(crate) class: u8,
    pub(crate) name: String,
    pub(crate) rings: Vec<Vec<LatticePoint>>,
}

impl AreaPiece {
    pub(crate) fn class(&self) -> Option<AreaClass> {
        AreaClass::from_number(self.class)
    }
}

impl SortRecord for AreaPiece {
    /// Numbers in little-endian order; the name has its length before it, and so has each ring.
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
        for ring in &self.rings {
            bytes.extend((ring.len() as u64).to_le_bytes());
            for point in ring {
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
        let mut rings = Vec::new();
        while !bytes.is_empty() {
            let count = usize::try_from(u64::from_le_bytes(array(bytes)?)).ok()?;
            if count > bytes.len() {
                return None;
            }
            let mut ring = Vec::with_capacity(count);
            for _ in 0..count {
                let u = i64::from_le_bytes(array(bytes)?);
                ring.push(LatticePoint { u, v: i64::from_le_bytes(array(bytes)?) });
            }
            rings.push(ring);
        }
        Some(Self { object, tile, class, name, rings })
    }

    fn extra_bytes(&self) -> usize {
        let points: usize = self.rings.iter().map(Vec::capacity).sum();
        points * size_of::<LatticePoint>()
            + self.rings.capacity() * size_of::<Vec<LatticePoint>>()
            + self.name.capacity()
    }
}

#[cfg(test)]
#[path = "area_piece_tests.rs"]
mod tests;
