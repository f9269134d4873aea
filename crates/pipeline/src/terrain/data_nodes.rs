//! The nodes at which a package can have data.

use corniche_geom::NodeIndex;
use corniche_tileset::Manifest;

/// South-western and north-eastern node of the data's rectangle.
pub(crate) fn data_nodes(manifest: &Manifest) -> [NodeIndex; 2] {
    let frame = &manifest.frame;
    let bounds = &manifest.data_bounds;
    let ([west, south], [east_m, north_m]) = (frame.origin_m(), frame.cell().to_array());
    let node = |x: f64, y: f64| NodeIndex {
        i: ((x - west) / east_m).round() as i64,
        j: ((y - south) / north_m).round() as i64,
    };
    [node(bounds.min_x, bounds.min_y), node(bounds.max_x, bounds.max_y)]
}
