//! Deviations: how far the TINs of all levels are from the nodes of the finest level.

use std::collections::BTreeMap;

use corniche_geom::{HeightGrid, TileId};
use corniche_tin::{Deviation, TriangleBuckets, WindowPlacement};

use super::mesh::{self, Meshes};
use crate::{
    BuildError, Observer, Stage, Storage, heights::pyramid::Pyramid, levels::Levels,
    sample_deviation::SampleSums, workers,
};

/// How far the TIN of one tile is from the nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TileDeviation {
    /// What the tile stores: never below the deviations of the tiles below it.
    pub(crate) geometric_error_m: f64,
    /// The largest deviation of the tile itself and of its children, each by its own TIN.
    pub(crate) deviation_m: f64,
    pub(crate) height_range_m: [f64; 2],
    pub(crate) uncovered_nodes: u64,
}

/// The deviations of all tiles.
pub(crate) struct TileDeviations {
    by_tile: BTreeMap<TileId, TileDeviation>,
    /// For each level, the number of nodes with data under tiles without ground.
    under_absent: BTreeMap<u8, u64>,
    /// Per level, root first: distances to the nodes that are not filled voids.
    at_nodes: Vec<SampleSums>,
}

impl TileDeviations {
    /// Nodes with data that no tile of the level covers because there is no tile above them.
    pub(crate) fn under_absent(&self, level: u8) -> u64 {
        self.under_absent.get(&level).copied().unwrap_or_default()
    }

    /// Per level, root first: how far the TINs are from the nodes that have their heights from the DEM. Where nodes are the
    /// DEM's samples, these are the distances to the samples.
    pub(crate) fn at_nodes(&self) -> &[SampleSums] {
        &self.at_nodes
    }

    /// The deviation of a tile that has a mesh. It is 0 for a tile of which no node was seen: its ground covers no node.
    pub(crate) fn of(&self, id: TileId) -> TileDeviation {
        self.by_tile.get(&id).copied().unwrap_or(TileDeviation {
            geometric_error_m: 0.0,
            deviation_m: 0.0,
            height_range_m: [0.0, 0.0],
            uncovered_nodes: 0,
        })
    }
}

/// How many levels one item of work spans: up to 64 finest tiles share the meshes of the levels above them.
const SUBTREE_LEVELS: u8 = 3;

/// What was seen of a tile from one subtree, or from all.
#[derive(Debug, Clone, Copy, Default)]
struct Seen {
    deviation: Deviation,
    range_m: Option<[f32; 2]>,
    uncovered_nodes: u64,
}

impl Seen {
    /// Maxima, minima and sums: the order of merging does not matter.
    fn merge(&mut self, other: Self) {
        self.deviation.merge(other.deviation);
        self.uncovered_nodes += other.uncovered_nodes;
        self.range_m = match (self.range_m, other.range_m) {
            (Some(a), Some(b)) => Some([a[0].min(b[0]), a[1].max(b[1])]),
            (a, b) => a.or(b),
        };
    }
}

/// Evaluates the TINs of a tile and all its ancestors at every node of every finest tile.
pub(crate) fn measure(
    pyramid: &Pyramid<'_>,
    meshes: &Meshes,
    levels: &Levels,
    threads: usize,
    storage: &dyn Storage,
    observer: &dyn Observer,
) -> Result<TileDeviations, BuildError> {
    let max_level = levels.frame().max_level();
    // All finest tiles with any height, those without ground too: a coarser level may cover their nodes.
    let finest = pyramid.tiles(max_level);
    let mut subtrees: BTreeMap<TileId, Vec<TileId>> = BTreeMap::new();
    for &id in &finest {
        subtrees.entry(id.ancestor(max_level.saturating_sub(SUBTREE_LEVELS))).or_default().push(id);
    }
    let subtrees: Vec<Vec<TileId>> = subtrees.into_values().collect();
    observer.begin(Stage::Deviations, Some(finest.len() as u64));
    let mut seen: BTreeMap<TileId, Seen> = BTreeMap::new();
    let mut under_absent: BTreeMap<u8, u64> = BTreeMap::new();
    let none = vec![SampleSums::new(levels.quantum_m()); levels.numbers().count()];
    let mut at_nodes = none.clone();
    workers::in_order_unless_cancelled(
        observer,
        threads,
        subtrees.len(),
        || Ok(()),
        |(), index| {
            let mut subtree = Subtree {
                meshes,
                levels,
                storage,
                buckets: BTreeMap::new(),
                seen: BTreeMap::new(),
                at_nodes: none.clone(),
            };
            for &id in &subtrees[index] {
                if observer.is_cancelled() {
                    return Err(BuildError::Interrupted);
                }
                subtree.look_at(id, &pyramid.tile(id, 0)?, &pyramid.filled(id)?)?;
            }
            Ok((subtree.seen, subtree.at_nodes))
        },
        |index, (found, nodes)| {
            for (sums, found) in at_nodes.iter_mut().zip(&nodes) {
                sums.merge(found);
            }
            for (id, other) in found {
                if meshes.contains_key(&id) {
                    seen.entry(id).or_default().merge(other);
                } else {
                    *under_absent.entry(id.z()).or_default() += other.uncovered_nodes;
                }
            }
            observer.advance(Stage::Deviations, subtrees[index].len() as u64);
            Ok(())
        },
    )?;
    observer.end(Stage::Deviations);
    Ok(TileDeviations { by_tile: stored(&seen, meshes), under_absent, at_nodes })
}

/// The work on one subtree.
struct Subtree<'a> {
    meshes: &'a Meshes,
    levels: &'a Levels,
    storage: &'a dyn Storage,
    buckets: BTreeMap<TileId, Option<TriangleBuckets>>,
    seen: BTreeMap<TileId, Seen>,
    at_nodes: Vec<SampleSums>,
}

impl Subtree<'_> {
    /// Counts the nodes of a window over which the tile `id` above it has no ground.
    fn add_uncovered(
        &mut self,
        id: TileId,
        window: &HeightGrid,
        is_own_sample: &dyn Fn(usize, usize) -> bool,
    ) {
        let side = window.columns();
        let inner = side - 1;
        let uncovered_nodes = window.window(0, 0, inner, inner).count_heights() as u64;
        let sums = &mut self.at_nodes[usize::from(id.z())];
        for row in 0..window.rows() {
            for column in 0..side {
                if window.has_height(column, row) && is_own_sample(column, row) {
                    sums.add(None);
                }
            }
        }
        let seen = Seen { uncovered_nodes, ..Seen::default() };
        self.seen.entry(id).or_default().merge(seen);
    }

    /// `filled` are the nodes of the window, by number, that are filled voids.
    fn look_at(
        &mut self,
        finest: TileId,
        window: &HeightGrid,
        filled: &[usize],
    ) -> Result<(), BuildError> {
        let frame = self.levels.frame();
        let side = window.columns();
        // Nodes on the east and south border belong to the next tile, if there can be one.
        let last_tile = (1_u32 << finest.z()) - 1;
        let own_columns = side - usize::from(finest.x() < last_tile);
        let own_rows = window.rows() - usize::from(finest.y() < last_tile);
        let mut is_sample = vec![true; side * window.rows()];
        for &node in filled {
            is_sample[node] = false;
        }
        let is_own_sample = |column: usize, row: usize| {
            column < own_columns && row < own_rows && is_sample[row * side + column]
        };
        // Tiles of a subtree come row by row. Of the finest levels, only the current tile is needed again.
        self.buckets.retain(|&id, _| {
            finest.ancestor(id.z()) == id || id.z() + SUBTREE_LEVELS <= finest.z()
        });
        for level in self.levels.numbers() {
            let id = finest.ancestor(level);
            let buckets = match self.buckets.entry(id) {
                std::collections::btree_map::Entry::Occupied(entry) => entry.into_mut(),
                std::collections::btree_map::Entry::Vacant(entry) => {
                    entry.insert(match self.meshes.get(&id) {
                        Some(&span) => {
                            let meshed = mesh::load(self.storage, id, span)?;
                            Some(TriangleBuckets::new(&meshed.tin, self.levels.quantum_m()))
                        }
                        None => None,
                    })
                }
            };
            let Some(buckets) = buckets else {
                self.add_uncovered(id, window, &is_own_sample);
                continue;
            };
            let (corner, above) = (frame.tile_corner(finest), frame.tile_corner(id));
            let placement = WindowPlacement {
                column: corner.i - above.i,
                row: above.j - corner.j,
                stride: frame.stride(level),
            };
            let last = window.columns() - 1;
            let mut uncovered_nodes = 0;
            let sums = &mut self.at_nodes[usize::from(level)];
            let look = |column, row, distance_m: Option<f64>| {
                // Nodes on the east and south border belong to the next tile, which counts them.
                uncovered_nodes += u64::from(distance_m.is_none() && column < last && row < last);
                if is_own_sample(column, row) {
                    sums.add(distance_m);
                }
            };
            let deviation = corniche_tin::measure(buckets, window, placement, look);
            self.seen.entry(id).or_default().merge(Seen {
                deviation,
                range_m: window.range_m(),
                uncovered_nodes,
            });
        }
        Ok(())
    }
}

/// Computes the geometric errors, from the finest level up: the maximum of the tile's own deviation and those of all tiles
/// beneath it.
///
/// A tile may lack ground where its children have some (an island too small for a cell of its level), so what is
/// beneath counts for the nearest tile above that exists.
fn stored(seen: &BTreeMap<TileId, Seen>, meshes: &Meshes) -> BTreeMap<TileId, TileDeviation> {
    let mut by_tile: BTreeMap<TileId, TileDeviation> = BTreeMap::new();
    let mut beneath_m: BTreeMap<TileId, f64> = BTreeMap::new();
    // Ids sort by level first, so in reverse order children come before their parents.
    for &id in meshes.keys().rev() {
        let own = seen.get(&id).copied().unwrap_or_default();
        let geometric_error_m =
            beneath_m.get(&id).copied().unwrap_or_default().max(own.deviation.max_abs_m);
        let above = (0..id.z())
            .rev()
            .map(|level| id.ancestor(level))
            .find(|above| meshes.contains_key(above));
        if let Some(above) = above {
            let largest_m = beneath_m.entry(above).or_default();
            *largest_m = largest_m.max(geometric_error_m);
        }
        let deviation_m = id
            .children()
            .filter_map(|child| seen.get(&child))
            .fold(own.deviation.max_abs_m, |largest, child| largest.max(child.deviation.max_abs_m));
        let [low, high] = own.range_m.unwrap_or([0.0, 0.0]);
        by_tile.insert(
            id,
            TileDeviation {
                geometric_error_m,
                deviation_m,
                height_range_m: [f64::from(low), f64::from(high)],
                uncovered_nodes: own.uncovered_nodes,
            },
        );
    }
    by_tile
}
