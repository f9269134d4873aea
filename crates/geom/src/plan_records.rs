//! What the plan of a grid and the manifest of its package say of the elevation files: which part they are of, and how true to scale.

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
