//! Layers of lines in the JSON documents of several commands.

use corniche_areas::BoundaryClass;
use corniche_geom::LatticePoint;
use corniche_tileset::{LineLevelRecord, LineRecord, LinesRecord};
use serde::Serialize;

#[cfg(test)]
use crate::documents::record_schemas::LineLevelDocument;

/// A layer of lines in a package.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct LinesDocument {
    /// Number of OSM ways in the extract that have a class, converted or not. Each is counted once,
    /// in its most important class.
    ways: u64,
    /// Converted OSM ways per class, also outside the package's extent.
    kept: Vec<LineClassDocument>,
    /// OSM ways that were skipped, by reason.
    lost: Vec<LineLossDocument>,
    /// Lines of each level that has some, root first.
    #[cfg_attr(test, schemars(with = "Vec<LineLevelDocument>"))]
    levels: Vec<LineLevelRecord>,
}

/// The lines of one class.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct LineClassDocument {
    /// Name of the class.
    class: &'static str,
    /// Number of ways.
    ways: u64,
    /// True length in plan, micrometres.
    length_um: u64,
}

/// The ways that were skipped for one reason.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct LineLossDocument {
    /// The reason.
    reason: String,
    /// Number of ways.
    ways: u64,
}

impl LinesDocument {
    pub(crate) fn from_record(LinesRecord { counts, levels }: LinesRecord) -> Self {
        let kept = counts.kept.into_iter().map(|kept| LineClassDocument {
            // The package reader has rejected other numbers.
            class: BoundaryClass::from_number(kept.class).map_or("", BoundaryClass::name),
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

/// The part of a boundary near a tile.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct TileBoundaryDocument {
    /// OSM id of the way.
    way_id: i64,
    /// The most important class of the boundary: "admin-2" to "admin-8" or "protected".
    class: &'static str,
    /// OSM's `admin_level` of that class; null for protected areas.
    admin_level: Option<u8>,
    /// Position (x and y) of each point. Segments are not clipped: each touches the tile or the
    /// margin of its level's width, and its ends may be outside.
    line: Vec<[f64; 2]>,
}

impl TileBoundaryDocument {
    /// Converts a record; `place` converts lattice points to coordinates.
    pub(crate) fn from_record(
        LineRecord { way_id, class, points }: LineRecord,
        place: impl Fn(LatticePoint) -> [f64; 2],
    ) -> Self {
        let line = points.into_iter().map(place).collect();
        Self { way_id, class: class.name(), admin_level: class.admin_level(), line }
    }
}
