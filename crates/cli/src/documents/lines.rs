//! Layers of lines in the JSON documents of several commands.

use corniche_areas::{BoundaryClass, ClassedLayer, LineClass};
use corniche_geom::LatticePoint;
use corniche_tileset::{LineLevelRecord, LineRecord, LinesRecord};
use serde::Serialize;

#[cfg(test)]
use crate::documents::record_schemas::LineLevelDocument;

/// A layer of lines of a package.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct LinesDocument {
    /// Ways of the extract that have a class: those kept and those lost. Each counts once, in its most important class.
    ways: u64,
    /// Those that were read, by class, wherever they lie.
    kept: Vec<LineClassDocument>,
    /// Those that were left out, by reason.
    lost: Vec<LineLossDocument>,
    /// For each level that has some, root first.
    #[cfg_attr(test, schemars(with = "Vec<LineLevelDocument>"))]
    levels: Vec<LineLevelRecord>,
}

/// Lines of one class.
#[derive(Serialize)]
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
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct LineLossDocument {
    /// Why.
    reason: String,
    /// How many.
    ways: u64,
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
            levels,
        }
    }
}

/// A part of a boundary near a tile.
#[derive(Serialize)]
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
    /// `place` makes coordinates from points of the lattice.
    pub(crate) fn of(
        LineRecord { way_id, class, points }: LineRecord,
        place: impl Fn(LatticePoint) -> [f64; 2],
    ) -> Self {
        let line = points.into_iter().map(place).collect();
        let admin_level =
            BoundaryClass::from_number(class.number()).and_then(BoundaryClass::admin_level);
        Self { way_id, class: class.name(), admin_level, line }
    }
}
