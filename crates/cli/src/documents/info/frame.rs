//! Where a package lies, in the document of `corniche info`.

use corniche_geom::{Bounds, GridFrame, NodeIndex};
use corniche_tileset::ClipRecord;
use serde::Serialize;

#[cfg(test)]
use crate::documents::record_schemas::NodeDocument;

/// The grid of a package.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct FrameDocument {
    /// Position of node 0, 0: x and y in working metres.
    origin_m: [f64; 2],
    /// Spacing of the finest nodes, east and north, working metres.
    cell_m: [f64; 2],
    /// North-west corner of the root tile.
    #[cfg_attr(test, schemars(with = "NodeDocument"))]
    root_corner: NodeIndex,
    /// The finest level.
    max_level: u8,
}

/// A rectangle.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct BoundsDocument {
    /// West edge.
    min_x: f64,
    /// South edge.
    min_y: f64,
    /// East edge.
    max_x: f64,
    /// North edge.
    max_y: f64,
}

/// The part of the elevation files that a package is of.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct ClipDocument {
    /// The bounds that were asked for, rounded outwards to whole cells: south-western and north-eastern node. They may reach
    /// beyond the data.
    #[cfg_attr(test, schemars(with = "[NodeDocument; 2]"))]
    nodes: [NodeIndex; 2],
    /// Rectangle of the nodes of all elevation files, working metres.
    whole_data_bounds: BoundsDocument,
    /// The same in WGS84 degrees.
    whole_wgs84_bounds: BoundsDocument,
}

impl From<ClipRecord> for ClipDocument {
    fn from(ClipRecord { nodes, whole_data_bounds, whole_wgs84_bounds }: ClipRecord) -> Self {
        Self {
            nodes,
            whole_data_bounds: whole_data_bounds.into(),
            whole_wgs84_bounds: whole_wgs84_bounds.into(),
        }
    }
}

/// A table of longitudes and latitudes over the working CRS, to be interpolated by Lagrange's cubic along both axes. It writes itself;
/// this is its schema.
#[cfg(test)]
#[derive(schemars::JsonSchema)]
#[expect(dead_code, reason = "only its schema is wanted")]
pub(crate) struct CoordinatesSchema {
    /// What it covers, working metres.
    bounds: BoundsDocument,
    /// Samples along each side.
    size: usize,
    /// Longitude and latitude of each sample, degrees, row by row from the south. Longitudes may run on past 180.
    samples_deg: Vec<[f64; 2]>,
}

impl From<&GridFrame> for FrameDocument {
    fn from(frame: &GridFrame) -> Self {
        Self {
            origin_m: frame.origin_m(),
            cell_m: frame.cell().to_array(),
            root_corner: frame.root_corner(),
            max_level: frame.max_level(),
        }
    }
}

impl From<Bounds> for BoundsDocument {
    fn from(Bounds { min_x, min_y, max_x, max_y }: Bounds) -> Self {
        Self { min_x, min_y, max_x, max_y }
    }
}
