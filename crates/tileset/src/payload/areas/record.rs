//! An area in a tile: its class, its object and its rings inside the tile.

use corniche_areas::{AreaClass, AreaObject};
use corniche_geom::LatticePoint;
use serde::{Deserialize, Serialize};

/// The part of an area that is in a tile.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct AreaRecord {
    /// The OSM object.
    pub object: AreaObject,
    /// The class of the area.
    pub class: AreaClass,
    /// The name of the area; empty if it has none.
    pub name: String,
    /// The parts of the area in the tile; at least one.
    pub polygons: Vec<AreaRings>,
}

impl AreaRecord {
    /// Iterates over all rings of the area.
    pub fn rings(&self) -> impl Iterator<Item = &Vec<LatticePoint>> {
        self.polygons.iter().flat_map(|part| &part.rings)
    }
}

/// A polygon: an outer ring, counter-clockwise, then rings around its holes, clockwise. The first
/// point of a ring is not repeated at its end. All points are in the tile or on its border.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct AreaRings {
    /// At least one ring, each of at least three points.
    pub rings: Vec<Vec<LatticePoint>>,
}
