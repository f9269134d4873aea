//! Layers of lines in the JSON documents of several commands.

use corniche_areas::{ClassedLayer, LineClass};
use corniche_tileset::{LineLevelRecord, LinesRecord};
use serde::Serialize;

/// A layer of lines of a package.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct LinesDocument {
    /// Ways of the extract that have a class: those kept and those lost. Each counts once, in its most important class.
    ways: u64,
    /// Those that were read, by class, wherever they lie.
    kept: Vec<LineClassDocument>,
    /// Those that were left out, by reason.
    lost: Vec<LineLossDocument>,
    /// For each level that has some, root first.
    levels: Vec<LineLevelDocument>,
}

/// Lines of one class.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct LineClassDocument {
    /// The name of the class.
    class: &'static str,
    /// How many ways.
    ways: u64,
    /// Their true length in plan, micrometres.
    length_um: u64,
}

/// Ways that were left out for one reason.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct LineLossDocument {
    /// Why.
    reason: String,
    /// How many.
    ways: u64,
}

/// The lines of a level.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct LineLevelDocument {
    /// Level, 0 = root.
    level: u8,
    /// Tiles with some.
    tiles: u64,
    /// Parts of lines near these tiles; one that comes near several tiles counts in each.
    parts: u64,
    /// Their points.
    points: u64,
    /// Stored bytes of their sections.
    bytes: u64,
}

impl LinesDocument {
    pub(crate) fn of(layer: ClassedLayer, LinesRecord { counts, levels }: LinesRecord) -> Self {
        let kept = counts.kept.into_iter().map(|kept| LineClassDocument {
            // The reader of packages has refused other numbers.
            class: layer.class(kept.class).map_or("", LineClass::name),
            ways: kept.ways,
            length_um: kept.length_um,
        });
        let lost = counts.lost.into_iter();
        Self {
            ways: counts.ways,
            kept: kept.collect(),
            lost: lost.map(|(reason, ways)| LineLossDocument { reason, ways }).collect(),
            levels: levels.into_iter().map(Into::into).collect(),
        }
    }
}

impl From<LineLevelRecord> for LineLevelDocument {
    fn from(LineLevelRecord { level, tiles, parts, points, bytes }: LineLevelRecord) -> Self {
        Self { level, tiles, parts, points, bytes }
    }
}
