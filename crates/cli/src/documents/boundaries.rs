//! Boundaries in the JSON documents of several commands.

use corniche_areas::BoundaryClass;
use corniche_geom::GridFrame;
use corniche_tileset::{BoundariesRecord, BoundaryLevelRecord, BoundaryRecord};
use serde::Serialize;

/// The boundaries of a package.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct BoundariesDocument {
    /// Ways of the extract that are boundaries: those kept and those lost. Each counts once, in its most important class.
    ways: u64,
    /// Those that were read, by class, wherever they lie.
    kept: Vec<BoundaryClassDocument>,
    /// Those that were left out, by reason.
    lost: Vec<BoundaryLossDocument>,
    /// For each level that has some, root first.
    levels: Vec<BoundaryLevelDocument>,
}

/// Boundaries of one class.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct BoundaryClassDocument {
    /// The class: "admin-2" to "admin-8" or "protected".
    class: &'static str,
    /// How many ways.
    ways: u64,
    /// Their true length in plan, micrometres.
    length_um: u64,
}

/// Ways that were left out for one reason.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct BoundaryLossDocument {
    /// Why.
    reason: String,
    /// How many.
    ways: u64,
}

/// The boundaries of a level.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct BoundaryLevelDocument {
    /// Level, 0 = root.
    level: u8,
    /// Tiles with boundaries.
    tiles: u64,
    /// Parts of boundaries near these tiles; one that comes near several tiles counts in each.
    parts: u64,
    /// Their points.
    points: u64,
    /// Stored bytes of their sections.
    bytes: u64,
}

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
        BoundaryRecord { way_id, class, points }: BoundaryRecord,
        frame: &GridFrame,
        place: &impl Fn([f64; 2]) -> [f64; 2],
    ) -> Self {
        let line = points.into_iter().map(|point| place(frame.position_m(point))).collect();
        Self { way_id, class: class.name(), admin_level: class.admin_level(), line }
    }
}

impl From<BoundariesRecord> for BoundariesDocument {
    fn from(BoundariesRecord { counts, levels }: BoundariesRecord) -> Self {
        let kept = counts.kept.into_iter().map(|kept| BoundaryClassDocument {
            // The reader of packages has refused other numbers.
            class: BoundaryClass::from_number(kept.class).map_or("", BoundaryClass::name),
            ways: kept.ways,
            length_um: kept.length_um,
        });
        let lost = counts.lost.into_iter();
        let level = |BoundaryLevelRecord { level, tiles, parts, points, bytes }| {
            BoundaryLevelDocument { level, tiles, parts, points, bytes }
        };
        Self {
            ways: counts.ways,
            kept: kept.collect(),
            lost: lost.map(|(reason, ways)| BoundaryLossDocument { reason, ways }).collect(),
            levels: levels.into_iter().map(level).collect(),
        }
    }
}
