//! How far the TINs of all levels are from the full resolution: measured at every finest node with data.

use std::collections::BTreeMap;

use corniche_dem::{Dem, DemWindow, GridPlan, Reader};
use corniche_geom::{HeightGrid, NodeIndex, NodeWindow, TileId};
use corniche_ground::heights::{finest::own_size, patch::union};
use corniche_spec::{Observer, data_tiles::DataTiles};
use corniche_tileset::{Manifest, SampleSums};
use corniche_work::{Stage, workers};

use super::{
    decoded_tiles::DecodedTiles, error::VerifyError, samples, triangle_soup::TriangleSoup,
};

/// How far a tile's TIN is from the nodes looked at so far.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct TrueDeviation {
    /// The largest distance.
    pub largest_m: f64,
    /// Nodes that the TIN covers.
    pub nodes: u64,
    /// Nodes with data that it does not cover.
    pub(crate) uncovered: u64,
    /// Lowest and highest node with data beneath.
    pub range_m: Option<[f32; 2]>,
    /// Uncovered nodes farther than one cell of the level from any void or edge.
    pub(crate) stray: u64,
}

impl TrueDeviation {
    pub(crate) fn merge(&mut self, other: Self) {
        self.largest_m = self.largest_m.max(other.largest_m);
        self.nodes += other.nodes;
        self.uncovered += other.uncovered;
        self.stray += other.stray;
        self.range_m = union(self.range_m, other.range_m);
    }
}

/// What was measured.
pub(crate) struct Measured {
    /// The deviation of every tile over the data, also of those without ground.
    pub(crate) by_tile: BTreeMap<TileId, TrueDeviation>,
    /// Per level, root first: distances at samples where nodes are samples; otherwise empty sums.
    pub(crate) at_samples: Vec<SampleSums>,
}

/// Compares the TINs of all levels with the elevation files.
pub(crate) fn measure(
    tiles: &DecodedTiles<'_>,
    dem: &Dem,
    plan: &GridPlan,
    threads: usize,
    observer: &dyn Observer,
) -> Result<Measured, VerifyError> {
    let manifest = tiles.package.manifest();
    let max_level = manifest.frame.max_level();
    // All finest tiles of the data, also those without ground: a coarser level may cover their nodes.
    let finest = DataTiles::of(plan).within(corniche_geom::TileId::ROOT);
    let mut truths: BTreeMap<TileId, TrueDeviation> = BTreeMap::new();
    let nodes_are_samples = plan.nodes_are_samples();
    let mut at_samples = samples::none(manifest);
    workers::side_by_side(
        (observer, Stage::Deviations),
        threads,
        &finest,
        || Ok::<_, VerifyError>(dem.reader(plan)),
        |reader, &id| {
            let read = reader.window(manifest.frame.tile_window(id))?;
            let mut found_at_samples = samples::none(manifest);
            let window = &read.heights;
            let mut found = Vec::new();
            for level in 0..=max_level {
                let ancestor = id.ancestor(level);
                // A tile that does not exist or cannot be read covers nothing: all its nodes count as uncovered.
                let ground = tiles.ground(ancestor);
                let sums = &mut found_at_samples[usize::from(level)];
                let mut look = |[column, row]: [usize; 2], distance_m: Option<f64>| {
                    if nodes_are_samples && is_own_sample(id, &read, [column, row]) {
                        sums.add(distance_m);
                    }
                };
                let (mut truth, bare) =
                    compare(&ground, [id, ancestor], window, manifest, &mut look);
                for (cell, nodes) in bare {
                    let stride = manifest.frame.stride(level);
                    truth.stray += if has_void_corner(cell, stride, reader)? { 0 } else { nodes };
                }
                found.push((ancestor, truth));
            }
            Ok((found, found_at_samples))
        },
        |_, (found, found_at_samples): (Vec<(TileId, TrueDeviation)>, Vec<SampleSums>)| {
            samples::merge(&mut at_samples, &found_at_samples);
            for (id, truth) in found {
                truths.entry(id).or_default().merge(truth);
            }
            Ok(())
        },
    )?;
    Ok(Measured { by_tile: truths, at_samples })
}

/// Compares an ancestor's TIN with the full resolution over one finest tile. Also gives the cells of the
/// ancestor's level, by north-west node, in which nodes with data are not covered, and how many each has.
fn compare(
    ground: &TriangleSoup,
    [finest, ancestor]: [TileId; 2],
    window: &HeightGrid,
    manifest: &Manifest,
    look: &mut dyn FnMut([usize; 2], Option<f64>),
) -> (TrueDeviation, BTreeMap<NodeIndex, u64>) {
    let frame = &manifest.frame;
    let stride = frame.stride(ancestor.z());
    let (corner, above) = (frame.tile_corner(finest), frame.tile_corner(ancestor));
    let mut truth = TrueDeviation { range_m: window.range_m(), ..TrueDeviation::default() };
    let mut bare: BTreeMap<NodeIndex, u64> = BTreeMap::new();
    let first = [corner.i - above.i, above.j - corner.j];
    let in_cells = first.map(|cells| cells as f64 / stride as f64);
    let grounds_m = ground.raster(in_cells, 1.0 / stride as f64, window.columns());
    for row in 0..window.rows() {
        for column in 0..window.columns() {
            let Some(height_m) = window.height(column, row) else { continue };
            let cells = [first[0] + column as i64, first[1] + row as i64];
            let ground_m = grounds_m[row * window.columns() + column];
            let distance_m = (!ground_m.is_nan()).then(|| (ground_m - f64::from(height_m)).abs());
            look([column, row], distance_m);
            match distance_m {
                Some(distance_m) => {
                    truth.nodes += 1;
                    truth.largest_m = truth.largest_m.max(distance_m);
                }
                // Border nodes belong to the tile east or south of them, which counts them.
                None if column + 1 < window.columns() && row + 1 < window.rows() => {
                    truth.uncovered += 1;
                    let [i, j] = cells.map(|cells| cells.div_euclid(stride) * stride);
                    *bare.entry(NodeIndex { i: above.i + i, j: above.j - j }).or_default() += 1;
                }
                None => {}
            }
        }
    }
    (truth, bare)
}

/// Whether a node of a finest tile's window is a sample, no filled void, that no other tile counts: those on the east and
/// south border belong to the next tile, if there can be one.
fn is_own_sample(id: TileId, read: &DemWindow, [column, row]: [usize; 2]) -> bool {
    let [columns, rows] = own_size(id);
    let is_filled = read.is_filled.get(row * read.heights.columns() + column);
    column < columns && row < rows && is_filled != Some(&true)
}

/// Whether a cell of a level lacks ground because one of its corners is void or beyond the data: then every node
/// in it lies within one cell of that level from a void or an edge.
fn has_void_corner(
    cell: NodeIndex,
    stride: i64,
    reader: &mut Reader<'_>,
) -> Result<bool, VerifyError> {
    for (i, j) in [(0, 0), (stride, 0), (0, stride), (stride, stride)] {
        let corner = NodeIndex { i: cell.i + i, j: cell.j - j };
        let node = reader.window(NodeWindow { corner, stride: 1, columns: 1, rows: 1 })?;
        if !node.heights.has_height(0, 0) {
            return Ok(true);
        }
    }
    Ok(false)
}
