//! Boundaries in `corniche tile --json`: what they have beside all lines.

use corniche_areas::BoundaryClass;
use corniche_geom::GridFrame;
use corniche_tileset::LineRecord;
use serde::Serialize;

/// A part of a boundary near a tile.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct TileBoundaryDocument {
    /// OSM's id of the way.
    way_id: i64,
    /// The most important of what it bounds: "admin-2" to "admin-8" or "protected".
    class: &'static str,
    /// OSM's `admin_level` of that; null for protected areas.
    admin_level: Option<u8>,
    /// x and y of each point. Segments are whole: each comes into the tile or its level's width margin, and its ends may lie outside.
    line: Vec<[f64; 2]>,
}

impl TileBoundaryDocument {
    /// `place` makes coordinates from working metres.
    pub(crate) fn of(
        LineRecord { way_id, class, points }: LineRecord,
        frame: &GridFrame,
        place: &impl Fn([f64; 2]) -> [f64; 2],
    ) -> Self {
        let line = points.into_iter().map(|point| place(frame.position_m(point))).collect();
        let admin_level =
            BoundaryClass::from_number(class.number()).and_then(BoundaryClass::admin_level);
        Self { way_id, class: class.name(), admin_level, line }
    }
}
