//! Bridges and tunnels in the JSON documents of several commands.

use corniche_tileset::{LineLevelRecord, SpanHeight, SpanPoint, SpanRun, SpansRecord};
use serde::Serialize;

#[cfg(test)]
use crate::documents::record_schemas::LineLevelDocument;

/// The bridges and tunnels of a package. Each is all ways of its kind that are connected; heights are estimates.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct SpansDocument {
    /// How many bridges.
    bridges: u64,
    /// How many tunnels.
    tunnels: u64,
    /// The true length of all bridges in plan, as far as they are kept, kilometres.
    bridges_km: f64,
    /// The same of all tunnels.
    tunnels_km: f64,
    /// Where they cross other roads or each other.
    crossings: u64,
    /// How often there is a reason to look at one, by its name.
    reasons: Vec<ReasonDocument>,
    /// What is off the ground on each level that has some, root first: runs are its parts.
    #[cfg_attr(test, schemars(with = "Vec<LineLevelDocument>"))]
    levels: Vec<LineLevelRecord>,
}

/// A reason to look at bridges or tunnels.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct ReasonDocument {
    /// Its name.
    reason: String,
    /// How often.
    count: u64,
}

impl From<SpansRecord> for SpansDocument {
    fn from(SpansRecord { counts, levels, .. }: SpansRecord) -> Self {
        let reasons = counts.reasons.into_iter();
        Self {
            bridges: counts.bridges,
            tunnels: counts.tunnels,
            bridges_km: counts.bridges_um as f64 / 1e9,
            tunnels_km: counts.tunnels_um as f64 / 1e9,
            crossings: counts.crossings,
            reasons: reasons.map(|(reason, count)| ReasonDocument { reason, count }).collect(),
            levels,
        }
    }
}

/// A stretch of a bridge that is above the ground of the tile's level, or of a tunnel that is below.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct TileSpanDocument {
    /// OSM's id of the way.
    way_id: i64,
    /// Functional road class.
    frc: u8,
    /// "bridge" or "tunnel".
    structure: &'static str,
    /// x, y and height in metres of each point. Heights are estimates.
    line: Vec<[f64; 3]>,
    /// Whether the first, and the last, of these points lies on the ground.
    on_ground: [bool; 2],
}

impl TileSpanDocument {
    /// The points of `line` are those of the run.
    pub(crate) fn of(run: &SpanRun, line: Vec<[f64; 3]>) -> Self {
        let is_on_ground = |point: Option<&SpanPoint>| {
            point.is_some_and(|point| matches!(point.height, SpanHeight::Ground { .. }))
        };
        Self {
            way_id: run.way_id,
            frc: run.class.number(),
            structure: run.structure.name(),
            line,
            on_ground: [run.points.first(), run.points.last()].map(is_on_ground),
        }
    }
}
