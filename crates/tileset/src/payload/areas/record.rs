//! An area as a tile holds it: its class, its object and its rings inside the tile.

use corniche_areas::{AreaClass, AreaObject};
use corniche_geom::LatticePoint;
use serde::{Deserialize, Serialize};

/// The part of an area that lies in a tile.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct AreaRecord {
    /// The object of OSM.
    pub object: AreaObject,
    /// What it is.
    pub class: AreaClass,
    /// Its name; empty for none.
    pub name: String,
    /// Its parts in the tile; at least one.
    pub polygons: Vec<AreaRings>,
}

impl AreaRecord {
    /// All its rings.
    pub fn rings(&self) -> impl Iterator<Item = &Vec<LatticePoint>> {
        self.polygons.iter().flat_map(|part| &part.rings)
    }
}

/// A polygon: an outer ring, counter-clockwise, then rings around its holes, clockwise. The first point of a ring is not repeated at its
/// end. All points lie in the tile or on its border.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct AreaRings {
    /// At least one ring, each of at least three points.
    pub rings: Vec<Vec<LatticePoint>>,
}
