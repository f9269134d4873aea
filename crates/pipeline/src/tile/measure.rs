//! Measures how far the TINs of a finest tile and of all its ancestors are from the heights of the
//! finest tile.

use std::sync::Arc;

use corniche_dem::{Dem, HeightReader};
use corniche_geom::{HeightGrid, TileId};
use corniche_ground::heights::finest::{FinestHeights, own_size};
use corniche_tileset::SampleSums;
use corniche_tin::{Surface, Tin, TriangleBuckets, WindowPlacement};
use corniche_work::Recent;

use super::{
    mesh::Meshed,
    record::{LevelShare, TinStatistics},
};
use crate::{BuildError, context::BuildContext};

/// The grounds of a finest tile and all tiles above it, root first; `None` for a tile without
/// ground.
pub(crate) struct Column {
    finest: TileId,
    grounds: Vec<Arc<Option<MeasuredGround>>>,
}

impl Column {
    pub(crate) fn new(
        context: &BuildContext<'_>,
        grounds: &GroundCache<'_>,
        finest: TileId,
        tin: Option<&Tin>,
    ) -> Result<Self, BuildError> {
        let above = (0..finest.z()).map(|level| grounds.ground_at(finest.ancestor(level)));
        let mut all = above.collect::<Result<Vec<_>, _>>()?;
        all.push(Arc::new(tin.map(|tin| MeasuredGround::new(context, finest, tin))));
        Ok(Self { finest, grounds: all })
    }

    /// Measures every level at every node, and at every sample if samples are not nodes. `heights`
    /// is `None` if no node has a height.
    pub(crate) fn measure(
        &self,
        context: &BuildContext<'_>,
        dem: &Dem,
        reader: &mut HeightReader<'_>,
        heights: Option<&FinestHeights>,
    ) -> Result<Vec<LevelShare>, BuildError> {
        let none = SampleSums::new(context.levels.quantum_m());
        let mut shares: Vec<LevelShare> = self
            .grounds
            .iter()
            .map(|ground| LevelShare {
                has_ground: ground.is_some(),
                seen: TinStatistics::default(),
                sums: none.clone(),
            })
            .collect();
        let nodes_are_samples = context.grid.nodes_are_samples();
        if let Some(heights) = heights {
            self.at_nodes(context, heights, nodes_are_samples, &mut shares);
        }
        if !nodes_are_samples {
            self.at_samples(context, dem, reader, &mut shares)?;
        }
        Ok(shares)
    }

    fn at_nodes(
        &self,
        context: &BuildContext<'_>,
        heights: &FinestHeights,
        nodes_are_samples: bool,
        shares: &mut [LevelShare],
    ) {
        let frame = context.frame();
        let finest = self.finest;
        let window = heights.with_halo(0);
        let range_m = window.range_m();
        let is_own_sample = own_samples(finest, &window, &heights.filled);
        let last = window.columns() - 1;
        for ((level, ground), share) in (0..).zip(&self.grounds).zip(shares) {
            let sums = &mut share.sums;
            let mut uncovered_nodes = 0;
            let mut look = |column: usize, row: usize, distance_m: Option<f64>| {
                // Nodes on the east and south border belong to the next tile, which counts them.
                uncovered_nodes += u64::from(distance_m.is_none() && column < last && row < last);
                if nodes_are_samples && is_own_sample[row * window.columns() + column] {
                    sums.add(distance_m);
                }
            };
            share.seen = if let Some(ground) = &**ground {
                let (corner, above) =
                    (frame.tile_corner(finest), frame.tile_corner(finest.ancestor(level)));
                let placement = WindowPlacement {
                    column: corner.i - above.i,
                    row: above.j - corner.j,
                    stride: frame.stride(level),
                };
                let found = corniche_tin::measure(&ground.buckets, &window, placement, look);
                TinStatistics { max_abs_m: found.max_abs_m, range_m, uncovered_nodes }
            } else {
                for row in 0..window.rows() {
                    for column in 0..window.columns() {
                        if window.has_height(column, row) {
                            look(column, row, None);
                        }
                    }
                }
                TinStatistics { uncovered_nodes, ..TinStatistics::default() }
            };
        }
    }

    /// Adds the distances to the DEM's own samples. Each sample belongs to one finest tile, by its
    /// position rounded to the lattice, like positions of roads.
    fn at_samples(
        &self,
        context: &BuildContext<'_>,
        dem: &Dem,
        reader: &mut HeightReader<'_>,
        shares: &mut [LevelShare],
    ) -> Result<(), BuildError> {
        let (frame, data) = (context.frame(), context.data());
        let root = frame.tile_lattice_bounds(TileId::ROOT);
        for range in dem.sample_ranges_of(context.grid, frame.tile_window(self.finest))? {
            let block = reader.used_samples(&range)?;
            for (&position_m, &height_m) in block.positions_m.iter().zip(&block.heights_m) {
                let Some(point) = frame.snap(position_m) else { continue };
                if data.owner(frame, point) != self.finest {
                    continue;
                }
                for (ground, share) in self.grounds.iter().zip(&mut *shares) {
                    let surface = Option::as_ref(ground).and_then(|ground| ground.surface.as_ref());
                    let distance_m = surface.filter(|_| root.contains(point)).and_then(|surface| {
                        let triangle = surface.locate(point)?;
                        let ground_m = surface.height_at_point_m(triangle, point);
                        Some((ground_m - f64::from(height_m)).abs())
                    });
                    share.sums.add(distance_m);
                }
            }
        }
        Ok(())
    }
}

/// Which nodes of a tile count as samples. Filled voids do not, nor do nodes on the east and south
/// border, which belong to the next tile if there can be one.
fn own_samples(finest: TileId, window: &HeightGrid, filled: &[usize]) -> Vec<bool> {
    let [columns, rows] = own_size(finest);
    let mut is_own = vec![false; window.columns() * window.rows()];
    for row in 0..rows {
        let from = row * window.columns();
        is_own[from..from + columns].fill(true);
    }
    for &node in filled {
        is_own[node] = false;
    }
    is_own
}

/// Memory for a triangle in buckets and in a surface, bytes.
const TRIANGLE_BYTES: u64 = 120;

/// A tile's ground, prepared for measuring.
pub(crate) struct MeasuredGround {
    pub buckets: TriangleBuckets,
    /// Only if samples are not nodes: samples are located by their position.
    pub surface: Option<Surface>,
    bytes: u64,
}

impl MeasuredGround {
    pub(crate) fn new(context: &BuildContext<'_>, id: TileId, tin: &Tin) -> Self {
        let quantum_m = context.levels.quantum_m();
        let surface = (!context.grid.nodes_are_samples())
            .then(|| Surface::of_tile(tin, context.frame(), id, quantum_m));
        let uses = 1 + u64::from(surface.is_some());
        Self {
            buckets: TriangleBuckets::new(tin, quantum_m),
            surface,
            bytes: tin.triangles().len() as u64 * TRIANGLE_BYTES * uses,
        }
    }
}

/// Grounds of the most recently used tiles, within a memory budget.
///
/// Finest tiles are processed in package order, along a Hilbert curve, so a coarse tile is needed
/// for a while and then never again.
pub(crate) struct GroundCache<'a> {
    context: &'a BuildContext<'a>,
    /// Ground by tile; `None` for a tile without ground.
    recent: Recent<TileId, Option<MeasuredGround>>,
}

impl<'a> GroundCache<'a> {
    pub(crate) fn new(context: &'a BuildContext<'a>) -> Self {
        Self { context, recent: Recent::new(context.memory().grounds) }
    }

    /// The ground of a coarse tile, or `None` if it has none.
    pub(crate) fn ground_at(&self, id: TileId) -> Result<Arc<Option<MeasuredGround>>, BuildError> {
        let make = || {
            let meshed = Meshed::get(self.context.store, id)?;
            Ok(meshed.map(|meshed| MeasuredGround::new(self.context, id, &meshed.tin)))
        };
        self.recent.get(id, make, |ground| ground.as_ref().map_or(0, |ground| ground.bytes))
    }
}
