//! Corners that several tiles share get one number in the whole model.

use std::collections::HashMap;

use corniche_geom::LatticePoint;

use super::model::{Corner, TileMesh};

/// Gives the corners of all tiles numbers, one to those that tiles share: positions there are the same to the bit.
#[derive(Default)]
pub(crate) struct Welding {
    on_borders: HashMap<LatticePoint, u32>,
}

impl Welding {
    /// The numbers of a tile's corners. `add` is called for those that are new, and tells the number.
    pub(crate) fn numbers<E>(
        &mut self,
        tile: &TileMesh,
        mut add: impl FnMut(&Corner) -> Result<u32, E>,
    ) -> Result<Vec<u32>, E> {
        let mut numbers = Vec::with_capacity(tile.corners.len());
        for corner in &tile.corners {
            let known = corner.shared.and_then(|point| self.on_borders.get(&point));
            let number = match known {
                Some(number) => *number,
                None => add(corner)?,
            };
            if let Some(point) = corner.shared {
                self.on_borders.insert(point, number);
            }
            numbers.push(number);
        }
        Ok(numbers)
    }
}
