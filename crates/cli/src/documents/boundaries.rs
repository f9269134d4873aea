//! Boundaries in the JSON documents of several commands.

use corniche_areas::BoundaryClass;
use corniche_tileset::{BoundariesRecord, BoundaryLevelRecord};
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
