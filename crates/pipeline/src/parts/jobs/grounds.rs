//! The cost of each tile's ground, derived from the number of its nodes in the rectangles of files.

use std::collections::{BTreeMap, BTreeSet};

use corniche_geom::{GridFrame, NodeIndex, TILE_CELLS, TileId};
use corniche_ground::terrain::recorded::RecordedTerrain;
use corniche_plan::{Opened, rates};
use corniche_spec::data_tiles::DataTiles;

use super::list::micros;
use crate::BuildError;

/// Costs of tiles on all levels, microseconds of one core.
pub(crate) struct LevelTileCosts {
    /// Cost of the step *heights*; `None` if the terrain comes from a package and there are no
    /// photos.
    pub heights: Option<Vec<(TileId, u64)>>,
    /// Cost of the step *tiles* without roads.
    pub tiles: Vec<(TileId, u64)>,
}

impl LevelTileCosts {
    /// The costs of ground from elevation files, by the nodes of each finest tile.
    pub(crate) fn measured(opened: &Opened, nodes: &[(TileId, u64)]) -> Self {
        let triangles_per_node = rates::triangles_per_node(opened.tolerance_cells());
        let tile_seconds_per_node = rates::SECONDS_PER_NODE - rates::HEIGHT_SECONDS_PER_NODE
            + triangles_per_node * rates::SECONDS_PER_TRIANGLE;
        let finest = |seconds_per_node: f64| {
            nodes.iter().map(move |&(id, nodes)| {
                (id, micros(rates::VOID_TILE_SECONDS + nodes as f64 * seconds_per_node))
            })
        };
        // A coarse tile has as many nodes as a finest one; if only a part of it has data, it has
        // fewer.
        let tile_nodes = (TILE_CELLS * TILE_CELLS) as f64;
        let coarse = |seconds_per_node: f64| {
            let beneath = nodes_above(nodes);
            beneath.into_iter().map(move |(id, nodes)| {
                let nodes = nodes.min(tile_nodes);
                (id, micros(rates::VOID_TILE_SECONDS + nodes * seconds_per_node))
            })
        };
        let heights =
            finest(rates::HEIGHT_SECONDS_PER_NODE).chain(coarse(rates::RASTER_SECONDS_PER_NODE));
        Self {
            heights: Some(heights.chain(photos(opened)).collect()),
            tiles: finest(tile_seconds_per_node).chain(coarse(tile_seconds_per_node)).collect(),
        }
    }

    /// The costs of ground from a package: the same for each tile with ground, because the package
    /// records sizes only by level.
    pub(crate) fn recorded(opened: &Opened, terrain: &RecordedTerrain) -> Result<Self, BuildError> {
        let levels = &terrain.manifest().levels;
        let with_ground: BTreeSet<TileId> = terrain.package().tile_ids()?.into_iter().collect();
        let ground_us = |id: &TileId| {
            let level = levels.get(usize::from(id.z()))?;
            let triangles = level.triangles as f64 / level.tiles.max(1) as f64;
            Some(micros(triangles * rates::SECONDS_PER_RECORDED_TRIANGLE))
        };
        let void_us = micros(rates::VOID_TILE_SECONDS);
        let all = DataTiles::from_plan(&opened.grid).within(TileId::ROOT);
        let all = all.into_iter().map(|id| (id, void_us));
        let grounds = with_ground.iter().map(|id| (*id, ground_us(id).unwrap_or_default()));
        let heights = opened.photo.files().is_some().then(|| photos(opened).collect());
        Ok(Self { heights, tiles: all.chain(grounds).collect() })
    }
}

/// The cost of the photos of finest tiles; photos of the levels above cost little in comparison.
fn photos(opened: &Opened) -> impl Iterator<Item = (TileId, u64)> {
    opened.photo.files().into_iter().flat_map(move |photos| {
        let seconds = rates::photo_texels(photos.levels()) * rates::SECONDS_PER_PHOTO_TEXEL;
        let seconds_of = move |id: TileId| {
            let is_covered = photos.grid.touches(&opened.grid.frame.tile_bounds(id));
            rates::VOID_TILE_SECONDS + if is_covered { seconds } else { 0.0 }
        };
        let finest = DataTiles::from_plan(&opened.grid).in_order_within(TileId::ROOT);
        finest.into_iter().map(move |id| (id, micros(seconds_of(id))))
    })
}

/// For each tile above some finest tiles, the number of nodes of its own level inside the data.
fn nodes_above(finest: &[(TileId, u64)]) -> BTreeMap<TileId, f64> {
    let mut all = BTreeMap::new();
    for &(id, nodes) in finest {
        for level in 0..id.z() {
            let share = 0.25_f64.powi((id.z() - level).into());
            *all.entry(id.ancestor(level)).or_default() += nodes as f64 * share;
        }
    }
    all
}

/// The number of nodes that belong to a tile.
const TILE_NODES: u64 = (TILE_CELLS * TILE_CELLS) as u64;

/// Returns all tiles of `data`, row by row, each with the number of its nodes in the rectangles,
/// which are given by their south-western and north-eastern node. Nodes in overlapping rectangles
/// count twice, but a tile never has more than all its nodes.
pub(crate) fn nodes_by_tile(
    frame: &GridFrame,
    data: &DataTiles,
    rectangles: &[[NodeIndex; 2]],
) -> Vec<(TileId, u64)> {
    let tiles = data.within(TileId::ROOT);
    let (Some(&first), Some(&last)) = (tiles.first(), tiles.last()) else { return Vec::new() };
    let columns = (last.x() - first.x() + 1) as usize;
    let mut counted: Vec<(TileId, u64)> = tiles.into_iter().map(|id| (id, 0)).collect();
    let corner = frame.root_corner();
    for [south_west, north_east] in rectangles {
        // Rows count from the north, nodes from the south.
        let across =
            overlaps([south_west.i - corner.i, north_east.i - corner.i], [first.x(), last.x()]);
        let down =
            overlaps([corner.j - north_east.j, corner.j - south_west.j], [first.y(), last.y()]);
        for &(y, rows) in &down {
            for &(x, nodes) in &across {
                let index = (y - first.y()) as usize * columns + (x - first.x()) as usize;
                let count = &mut counted[index].1;
                *count = (*count + rows * nodes).min(TILE_NODES);
            }
        }
    }
    counted
}

/// The number of nodes from `low` to `high` along an axis that belong to each tile from `first` to
/// `last`; tiles without nodes are skipped.
fn overlaps([low, high]: [i64; 2], [first, last]: [u32; 2]) -> Vec<(u32, u64)> {
    let tile_of = |node: i64| node.div_euclid(TILE_CELLS);
    let from = tile_of(low).max(i64::from(first));
    // The last tile also has the nodes on its far border.
    let to = tile_of(high).min(i64::from(last));
    (from..=to)
        .map(|tile| {
            let begin = low.max(tile * TILE_CELLS);
            let end = high.min((tile + 1) * TILE_CELLS - 1);
            (tile as u32, (end - begin + 1).max(0) as u64)
        })
        .collect()
}

#[cfg(test)]
#[path = "grounds_tests.rs"]
mod tests;
