//! Areas that users draw on the map.

use corniche_areas::{Polygon, cut_out, surrounded};
use corniche_geom::{GridFrame, LatticeBounds, LatticePoint};
use corniche_layers::OsmObject;
use corniche_tileset::{AreaPolygon, LayerSlot};

use super::{AreaVolumes, TileArea, TileGeometry};
use crate::layer_class::LayerClass;

/// A user-drawn area in plan. If its outline crosses itself, the even-odd rule decides what is
/// inside.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DrawnArea {
    polygons: Vec<Polygon>,
}

impl DrawnArea {
    /// The area inside a closed line; its first point follows the last. `None` if the line is far
    /// too intricate.
    #[must_use]
    pub fn new(outline: &[LatticePoint]) -> Option<Self> {
        surrounded(&[outline], 1).ok().map(|polygons| Self { polygons })
    }

    /// The volumes over the part of the area in a tile; none if it is far too intricate. Their
    /// class is the first one of the first layer.
    #[must_use]
    pub fn over(&self, tile: &TileGeometry, frame: &GridFrame) -> AreaVolumes {
        let bounds = frame.tile_lattice_bounds(tile.id);
        let is_near = |polygon: &&Polygon| {
            let around = LatticeBounds::around(polygon.outer().points());
            around.is_some_and(|around| around.intersects(&bounds))
        };
        let near: Vec<Polygon> = self.polygons.iter().filter(is_near).cloned().collect();
        let rings = |polygon: &Polygon| AreaPolygon {
            rings: polygon.rings().map(|ring| ring.points().to_vec()).collect(),
        };
        let inside = cut_out(&near, &bounds).ok();
        let volumes = inside.and_then(|inside| {
            let area = TileArea {
                class: LayerClass { layer: LayerSlot::new(0_u8)?, class: 0 },
                object: OsmObject::Way(0),
                polygons: inside.iter().map(rings).collect(),
            };
            AreaVolumes::new(&[area], tile.id, frame, &tile.ground, tile.reference_m).ok()
        });
        volumes.unwrap_or_default()
    }
}

#[cfg(test)]
#[path = "drawn_area_tests.rs"]
mod tests;
