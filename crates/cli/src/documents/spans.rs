//! Spans in `corniche tile --json`: where bridges and tunnels leave the ground.

use corniche_roads::Structure;
use corniche_tileset::{SpanHeight, SpanPoint, SpanRun};
use serde::Serialize;

/// A stretch of a bridge that is above the ground of the tile's level, or of a tunnel that is below.
#[derive(Debug, Serialize)]
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
            structure: structure_name(run.structure),
            line,
            on_ground: [run.points.first(), run.points.last()].map(is_on_ground),
        }
    }
}

/// What carries a road, in one word.
pub(crate) fn structure_name(structure: Structure) -> &'static str {
    match structure {
        Structure::Ground => "ground",
        Structure::Bridge => "bridge",
        Structure::Tunnel => "tunnel",
    }
}
