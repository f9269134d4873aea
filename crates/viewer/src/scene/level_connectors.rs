//! Short pieces of road that join roads of neighbouring tiles with different levels.

use std::collections::BTreeMap;

use corniche_geom::TileId;

use crate::tiles::{RoadEnd, RoadKind};

/// Maximum distance between ends of one way in two tiles that are connected, as a share of the
/// coarser tile: two of its cells, far more than simplification moves a line.
const MAX_OFFSET_SHARE: f64 = 2.0 / 256.0;

/// The data of a drawn tile that connectors need.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BorderTile<'a> {
    /// Id of the tile.
    pub(crate) id: TileId,
    /// Length of the shorter side, metres.
    pub(crate) side_m: f64,
    /// Depth of the skirt, true metres.
    pub(crate) skirt_depth_m: f64,
    /// Reference point of the tile.
    pub(crate) reference_m: [f64; 3],
    /// Points where roads meet the tile's border.
    pub(crate) ends: &'a [RoadEnd],
}

/// A piece of road over the step between two tiles of different levels.
///
/// ```text
///     coarse │ fine            In both tiles the road ends exactly on their common border, but at the height of
///            │  ●━━━━━━━       each tile's own ground and, if the coarse line is simplified, at another place.
///            │ ╱  skirt        The step between the two ends is closed by a skirt. No road is drawn on skirts,
///   ━━━━━━━━━●                 except by the connector ╱, which paints the ground and skirts of both tiles.
/// ```
///
/// Agrawal, Radhakrishna & Joshi 2006, *Geometry-based Mapping and Rendering of Vector Data over
/// LOD Phototextured 3D Terrain Models*, section 4.4.2 (special case 2), move the vector points
/// onto the triangles that fill the crack. Our cracks are filled by vertical skirts, where there is
/// nothing to move a point onto.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LevelConnector {
    /// Index of the finer tile in the list.
    pub(crate) fine: usize,
    /// Index of the coarser tile in the list.
    pub(crate) coarse: usize,
    /// Kind of the road.
    pub(crate) kind: RoadKind,
    /// The two ends in plan, working CRS: first in the finer tile, then in the coarser one.
    pub(crate) ends_m: [[f64; 2]; 2],
    /// The true height of each end; the lowest, if only a range is known.
    pub(crate) heights_m: [f64; 2],
    /// The lowest and the highest true height of the ground and skirts to paint.
    pub(crate) height_range_m: [f64; 2],
    /// Working metres across the road per true metre across it.
    pub(crate) width_factor: f32,
}

/// Returns the connectors between drawn tiles, in order of the finer tiles, then of class.
pub(crate) fn level_connectors(tiles: &[BorderTile<'_>]) -> Vec<LevelConnector> {
    let index_of: BTreeMap<TileId, usize> =
        tiles.iter().enumerate().map(|(index, tile)| (tile.id, index)).collect();
    let mut found = Vec::new();
    for (fine, tile) in tiles.iter().enumerate() {
        for end in tile.ends {
            let (dx, dy) = end.side.offset();
            let coarse = tile.id.neighbour(dx, dy).and_then(|beside| {
                (0..tile.id.z()).rev().find_map(|z| index_of.get(&beside.ancestor(z)))
            });
            let Some(&coarse) = coarse else { continue };
            let beyond = &tiles[coarse];
            let Some(partner) = partner(end, beyond) else { continue };
            let skirt_m = tile.skirt_depth_m.max(beyond.skirt_depth_m);
            let [low, high] = [end.height_range_m, partner.height_range_m];
            found.push(LevelConnector {
                fine,
                coarse,
                kind: end.kind,
                ends_m: [end.at_m, partner.at_m],
                width_factor: end.width_factor,
                heights_m: [low[0], high[0]],
                height_range_m: [low[0].min(high[0]) - skirt_m, low[1].max(high[1]) + skirt_m],
            });
        }
    }
    found.sort_by_key(|connector| (connector.fine, connector.kind.class));
    found
}

/// The continuation of the way in the neighbouring tile: its nearest end on the side that faces
/// this tile.
fn partner<'a>(end: &RoadEnd, beyond: &BorderTile<'a>) -> Option<&'a RoadEnd> {
    let distance_m =
        |other: &RoadEnd| libm::hypot(other.at_m[0] - end.at_m[0], other.at_m[1] - end.at_m[1]);
    beyond
        .ends
        .iter()
        .filter(|other| other.way_id == end.way_id && other.side == end.side.opposite())
        .filter(|other| distance_m(other) <= MAX_OFFSET_SHARE * beyond.side_m)
        .min_by(|a, b| distance_m(a).total_cmp(&distance_m(b)))
}

#[cfg(test)]
#[path = "level_connectors_tests.rs"]
mod tests;
