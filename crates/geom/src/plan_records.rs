//! Records about the elevation files, in the plan of a grid and in the manifest of its package: the
//! selected part, the scale, and the transformations between datums.

use serde::{Deserialize, Serialize};

use crate::{Bounds, NodeIndex};

/// The part of the elevation files that a package covers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ClipRecord {
    /// The requested bounds, including those of a polygon, rounded outwards to whole cells:
    /// south-western and north-eastern node. They may extend beyond the data.
    pub nodes: [NodeIndex; 2],
    /// Rectangle of the nodes of all elevation files, in working metres.
    pub whole_data_bounds: Bounds,
    /// Rectangle of the nodes of all elevation files, in WGS84 degrees. The scales of the package,
    /// and PROJ's choice of operations, are those for this rectangle.
    pub whole_wgs84_bounds: Bounds,
}

/// Working metres per true metre, along x and along y; values are limited to 0.001 to 1000.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ScaleRecord {
    /// The scale at the centre of the data.
    pub center: [f64; 2],
    /// The smallest scale over the corners, the middles of the sides and the centre of every file.
    pub least: [f64; 2],
    /// The largest scale over the corners, the middles of the sides and the centre of every file.
    pub largest: [f64; 2],
}

/// An operation that transforms positions from one datum to another: roads from WGS84 to the
/// package, or elevation files to the package.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DatumOperationRecord {
    /// The source CRS: "EPSG:…" if it has a code, else its name.
    pub from: String,
    /// The target CRS. The operation is also used in the opposite direction.
    pub to: String,
    /// PROJ's name for the operation.
    pub operation: String,
    /// The accuracy of the operation in metres; omitted if PROJ does not know it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accuracy_m: Option<f64>,
    /// Whether one datum was treated as another ("ballpark"), because PROJ knows no transformation
    /// between them (`--allow-ballpark`); omitted if not.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub ballpark: bool,
}

impl DatumOperationRecord {
    /// The accuracy as text.
    #[must_use]
    pub fn accuracy_text(&self) -> String {
        self.accuracy_m
            .map_or_else(|| "of unknown accuracy".to_owned(), |m| format!("accurate to {m} m"))
    }
}
