//! Bridges and tunnels in the JSON documents of several commands.

use corniche_roads::FunctionalRoadClass;
use corniche_tileset::{
    LayerSlot, Manifest, SectionLevelRecord, SpanHeight, SpanPoint, SpanRun, SpansRecord,
};
use schemars::JsonSchema;
use serde::Serialize;

#[cfg(test)]
use crate::documents::record_schemas::SectionLevelDocument;

/// The bridges and tunnels of a package (spans). A bridge or tunnel consists of all connected OSM
/// ways of its kind; heights are estimates. All lengths are those of roads.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct SpansDocument {
    /// Number of bridges of roads.
    bridges: u64,
    /// Number of tunnels of roads.
    tunnels: u64,
    /// True length in plan of the parts of all bridges in the package, kilometres.
    bridges_km: f64,
    /// True length in plan of the parts of all tunnels in the package, kilometres.
    tunnels_km: f64,
    /// Number of bridges of railways alone.
    railway_bridges: u64,
    /// Number of tunnels of railways alone.
    railway_tunnels: u64,
    /// Number of crossings with other roads and railways or with each other.
    crossings: u64,
    /// The same number by what is above and what is below.
    crossings_by_kind: Vec<CrossingsDocument>,
    /// Number of spans to inspect, by reason.
    reasons: Vec<ReasonDocument>,
    /// Stretches off the ground (runs, here `parts`) on each level that has some, root first.
    #[cfg_attr(test, schemars(with = "Vec<SectionLevelDocument>"))]
    levels: Vec<SectionLevelRecord>,
}

/// Crossings of bridges and tunnels with what is above or below them.
#[derive(Serialize, JsonSchema)]
struct CrossingsDocument {
    /// What is above: "roads" or "railways".
    upper: String,
    /// What is below: "roads" or "railways".
    lower: String,
    /// Number of crossings.
    count: u64,
}

/// A reason to inspect bridges or tunnels.
#[derive(Serialize, JsonSchema)]
struct ReasonDocument {
    /// Name of the reason.
    reason: String,
    /// Number of occurrences.
    count: u64,
}

impl From<SpansRecord> for SpansDocument {
    fn from(SpansRecord { counts, levels, .. }: SpansRecord) -> Self {
        let crossings = counts.crossings();
        let (by_kind, reasons) = (counts.crossings.into_iter(), counts.reasons.into_iter());
        Self {
            bridges: counts.bridges,
            tunnels: counts.tunnels,
            bridges_km: counts.bridges_um as f64 / 1e9,
            tunnels_km: counts.tunnels_um as f64 / 1e9,
            railway_bridges: counts.railway_bridges,
            railway_tunnels: counts.railway_tunnels,
            crossings,
            crossings_by_kind: by_kind
                .map(|(upper, lower, count)| CrossingsDocument { upper, lower, count })
                .collect(),
            reasons: reasons.map(|(reason, count)| ReasonDocument { reason, count }).collect(),
            levels,
        }
    }
}

/// A stretch of a bridge above the ground of the tile's level, or of a tunnel below it.
#[derive(Serialize, JsonSchema)]
pub(crate) struct TileSpanDocument {
    /// OSM id of the way.
    way_id: i64,
    /// Functional road class (FRC); null for a line of a layer.
    frc: Option<u8>,
    /// Id of the layer; null for a road.
    layer: Option<String>,
    /// "bridge" or "tunnel".
    structure: &'static str,
    /// Position (x, y and height in metres) of each point. Heights are estimates.
    line: Vec<[f64; 3]>,
    /// Whether the first and the last point are on the ground.
    on_ground: [bool; 2],
}

impl TileSpanDocument {
    /// Converts a run of a package; `line` has its points.
    pub(crate) fn from_run(run: &SpanRun, line: Vec<[f64; 3]>, manifest: &Manifest) -> Self {
        let layer = |slot: LayerSlot| Some(manifest.layers.get(slot.index())?.table.id.clone());
        let is_on_ground = |point: Option<&SpanPoint>| {
            point.is_some_and(|point| matches!(point.height, SpanHeight::Ground { .. }))
        };
        Self {
            way_id: run.way_id,
            frc: run.owner.road_class().map(FunctionalRoadClass::number),
            layer: run.owner.layer().and_then(layer),
            structure: run.structure.name(),
            line,
            on_ground: [run.points.first(), run.points.last()].map(is_on_ground),
        }
    }
}
