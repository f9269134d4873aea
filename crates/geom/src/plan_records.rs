//! What the plan of a grid and the manifest of its package say of the elevation files: which part they are of, how true to scale, and how positions come to
//! their datum.

use serde::{Deserialize, Serialize};

use crate::{Bounds, NodeIndex};

/// The part of the elevation files that a package is of.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ClipRecord {
    /// The bounds that were asked for, those of a polygon included, rounded outwards to whole cells: south-western and north-eastern node. They may reach
    /// beyond the data.
    pub nodes: [NodeIndex; 2],
    /// Rectangle of the nodes of all elevation files, working metres.
    pub whole_data_bounds: Bounds,
    /// The same in WGS84 degrees. The scales of the package, and PROJ's choice of an operation, are those for it.
    pub whole_wgs84_bounds: Bounds,
}

/// Working metres to a true metre, along x and along y; scales beyond 0.001 to 1000 are given as these.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ScaleRecord {
    /// The scale in the middle of the data.
    pub center: [f64; 2],
    /// The smallest over corners, middles of sides and centre of every file.
    pub least: [f64; 2],
    /// The largest.
    pub largest: [f64; 2],
}

/// How positions come from one datum to another: roads from WGS84 to the package, or elevation files to it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DatumOperationRecord {
    /// The system that positions are in: "EPSG:…" where it has a code, else its name.
    pub from: String,
    /// The system that they come to. The operation is also used the other way around.
    pub to: String,
    /// PROJ's name for the operation.
    pub operation: String,
    /// How accurate it is, metres; left out where PROJ does not know it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accuracy_m: Option<f64>,
    /// Whether one datum was taken for another ("ballpark"), as PROJ knows nothing between them (`--allow-ballpark`); left out where not.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub ballpark: bool,
}

impl DatumOperationRecord {
    /// Its accuracy in words.
    #[must_use]
    pub fn accuracy_text(&self) -> String {
        self.accuracy_m
            .map_or_else(|| "of unknown accuracy".to_owned(), |m| format!("accurate to {m} m"))
    }
}
