//! Measures the deviation of the TINs of all levels from the full resolution at every finest node
//! with data, and compares it with the numbers in the package.

use std::collections::BTreeMap;

use corniche_dem::{Dem, DemWindow, GridPlan, HeightReader};
use corniche_geom::{HeightGrid, NodeIndex, NodeWindow, TileId};
use corniche_ground::heights::{finest::own_size, patch::union};
use corniche_spec::data_tiles::DataTiles;
use corniche_tileset::{Distribution, Manifest, SampleSums, VerticalRecord};
use corniche_work::{Stage, workers};

use super::{
    checks::Findings,
    decoded_tiles::DecodedTiles,
    each_tile::VerifyRun,
    error::{Result, VerifyError},
    report::ErrorFigures,
    samples,
    triangle_soup::{HEIGHT_ROUNDING_M, TriangleSoup},
};

/// The deviation of a tile's TIN from the nodes compared so far.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct TrueDeviation {
    /// The largest deviation.
    pub largest_m: f64,
    /// The number of nodes that the TIN covers.
    pub nodes: u64,
    /// The number of nodes with data that the TIN does not cover.
    pub uncovered: u64,
    /// The lowest and the highest node with data beneath the tile.
    pub range_m: Option<[f32; 2]>,
    /// The number of uncovered nodes farther than one cell of the level from any void or edge.
    pub stray: u64,
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

/// The result of the measurement.
pub(crate) struct Measured {
    /// The deviation of every tile over the data, including tiles without ground.
    pub by_tile: BTreeMap<TileId, TrueDeviation>,
    /// Per level, root first: distances at samples, if the nodes are samples; otherwise empty sums.
    pub at_samples: Vec<SampleSums>,
}

/// Compares the TINs of all levels with the elevation files.
pub(crate) fn measure(run: &VerifyRun<'_>, (dem, plan): &(Dem, GridPlan)) -> Result<Measured> {
    let manifest = run.package.manifest();
    let max_level = manifest.frame.max_level();
    // All finest tiles of the data, including those without ground: a coarser level may cover their
    // nodes.
    let finest = DataTiles::from_plan(plan).within(corniche_geom::TileId::ROOT);
    let mut truths: BTreeMap<TileId, TrueDeviation> = BTreeMap::new();
    let nodes_are_samples = plan.nodes_are_samples();
    let mut at_samples = samples::none(manifest);
    workers::side_by_side(
        (run.observer, Stage::Deviations),
        run.threads,
        &finest,
        || Ok::<_, VerifyError>(dem.reader(plan)),
        |reader, &id| {
            let read = reader.window(manifest.frame.tile_window(id))?;
            let mut found_at_samples = samples::none(manifest);
            let window = &read.heights;
            let mut found = Vec::new();
            for level in 0..=max_level {
                let ancestor = id.ancestor(level);
                // A tile that does not exist or cannot be read covers nothing: all its nodes count
                // as uncovered.
                let ground = run.tiles.ground(ancestor);
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

/// Compares an ancestor's TIN with the full resolution over one finest tile. Also returns the cells
/// of the ancestor's level, by north-west node, that have uncovered nodes with data, with the
/// number of these nodes.
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

/// Whether a node of a finest tile's window is a sample (not a filled void) that no other tile
/// counts: nodes on the east and south borders belong to the next tile, if one can exist.
fn is_own_sample(id: TileId, read: &DemWindow, [column, row]: [usize; 2]) -> bool {
    let [columns, rows] = own_size(id);
    let is_filled = read.is_filled.get(row * read.heights.columns() + column);
    column < columns && row < rows && is_filled != Some(&true)
}

/// Whether a cell of a level lacks ground because one of its corners is void or beyond the data:
/// then every node in the cell lies within one cell of that level from a void or an edge.
fn has_void_corner(cell: NodeIndex, stride: i64, reader: &mut HeightReader<'_>) -> Result<bool> {
    for (i, j) in [(0, 0), (stride, 0), (0, stride), (stride, stride)] {
        let corner = NodeIndex { i: cell.i + i, j: cell.j - j };
        let node = reader.window(NodeWindow { corner, stride: 1, columns: 1, rows: 1 })?;
        if !node.heights.has_height(0, 0) {
            return Ok(true);
        }
    }
    Ok(false)
}

/// The tolerance for ratios of heights that were computed in two ways.
const RATIO_ROUNDING: f64 = 1e-3;
/// The factor of P2's tightness: stored ≤ this × true + a quantum, for most tiles.
const TIGHTNESS: f64 = 2.0;
const TIGHT_SHARE: f64 = 0.95;

/// Compares stored errors with true ones; returns the figures of each level.
pub(crate) fn verify(
    tiles: &DecodedTiles<'_>,
    truths: &BTreeMap<TileId, TrueDeviation>,
    findings: &mut Findings,
) -> Result<Vec<ErrorFigures>> {
    let manifest = tiles.package.manifest();
    let stored_m = check_tiles(tiles, truths, findings)?;
    let mut levels: BTreeMap<u8, TrueDeviation> = BTreeMap::new();
    for (&id, truth) in truths {
        // Tiles that do not exist count too: the nodes beneath them must be near a void or an edge.
        look!(
            findings,
            Stray,
            truth.stray == 0,
            "tile {id}: {} uncovered nodes are farther away",
            truth.stray
        );
        levels.entry(id.z()).or_default().merge(*truth);
    }
    for level in &manifest.levels {
        let found = levels.get(&level.level).map_or(0, |truth| truth.uncovered);
        look!(
            findings,
            Uncovered,
            found == level.uncovered_nodes,
            "level {} records {} uncovered nodes, {found} were found",
            level.level,
            level.uncovered_nodes
        );
    }
    let mut ratios = check_errors(manifest, &stored_m, truths, findings);
    let figures = levels.into_iter().map(|(level, truth)| {
        let tightness = Distribution::from_values(ratios.remove(&level).unwrap_or_default());
        let said = manifest.levels.get(usize::from(level)).and_then(|record| record.tightness);
        look!(
            findings,
            Recorded,
            agree(said, tightness),
            "level {level} records {said:?}, found {tightness:?}"
        );
        ErrorFigures {
            level,
            tiles: stored_m.keys().filter(|id| id.z() == level).count() as u64,
            nodes: truth.nodes,
            largest_true_m: truth.largest_m,
            tightness,
            uncovered_nodes: truth.uncovered,
        }
    });
    Ok(figures.collect())
}

/// Checks what tiles with ground record about the nodes beneath them; returns their stored errors.
fn check_tiles(
    tiles: &DecodedTiles<'_>,
    truths: &BTreeMap<TileId, TrueDeviation>,
    findings: &mut Findings,
) -> Result<BTreeMap<TileId, f64>> {
    let mut stored_m = BTreeMap::new();
    for id in tiles.package.tile_ids()? {
        let tile = tiles.tile_at(id);
        let Some(terrain) = tile.terrain() else { continue };
        let said = terrain.uncovered_nodes;
        let truth = truths.get(&id).copied().unwrap_or_default();
        look!(
            findings,
            Uncovered,
            said == truth.uncovered,
            "tile {id} records {said} uncovered nodes, {} were found",
            truth.uncovered
        );
        let [low, high] = terrain.height_range_m;
        let said = [low, high].map(f64::to_bits);
        let holds = truth.range_m.is_none_or(|range| range.map(|m| f64::from(m).to_bits()) == said);
        look!(
            findings,
            Ranges,
            holds,
            "tile {id} records {low} to {high} m, the nodes beneath have {:?}",
            truth.range_m
        );
        stored_m.insert(id, terrain.geometric_error_m);
    }
    Ok(stored_m)
}

/// Compares each stored error with the true one; returns, per level, the ratios of stored to true
/// errors, where the true error is large enough to be measured.
fn check_errors(
    manifest: &Manifest,
    stored_m: &BTreeMap<TileId, f64>,
    truths: &BTreeMap<TileId, TrueDeviation>,
    findings: &mut Findings,
) -> BTreeMap<u8, Vec<f64>> {
    let quantum_m = manifest.vertical.quantum_m;
    let mut ratios: BTreeMap<u8, Vec<f64>> = BTreeMap::new();
    let mut loose = 0_u64;
    for (&id, &stored_m) in stored_m {
        let truth = truths.get(&id).copied().unwrap_or_default();
        look!(
            findings,
            Bound,
            stored_m >= truth.largest_m - HEIGHT_ROUNDING_M,
            "tile {id} stores an error of {stored_m} m, but is off by {} m",
            truth.largest_m
        );
        if id.z() == manifest.frame.max_level() {
            let most_m = manifest.settings.max_error_m + HEIGHT_ROUNDING_M;
            look!(
                findings,
                Finest,
                truth.largest_m <= most_m,
                "tile {id} is off by {} m",
                truth.largest_m
            );
        }
        let children_m = id
            .children()
            .filter_map(|child| truths.get(&child))
            .fold(0.0_f64, |largest, child| largest.max(child.largest_m));
        let true_m = truth.largest_m.max(children_m);
        loose += u64::from(stored_m > TIGHTNESS * true_m + quantum_m);
        if true_m >= VerticalRecord::least_measured_error_m(quantum_m) {
            ratios.entry(id.z()).or_default().push(stored_m / true_m);
        }
    }
    let count = stored_m.len() as u64;
    let is_tight = loose as f64 <= (1.0 - TIGHT_SHARE) * count as f64;
    look!(
        findings,
        Tight,
        is_tight,
        "{loose} of {count} tiles store more than twice the true error"
    );
    ratios
}

/// Whether two distributions of ratios are equal apart from rounding: their errors were computed in
/// two ways.
fn agree(said: Option<Distribution>, found: Option<Distribution>) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() <= RATIO_ROUNDING * a.max(b);
    match (said, found) {
        (Some(said), Some(found)) => {
            let figures = |of: Distribution| [of.min, of.median, of.p95, of.max];
            let mut pairs = figures(said).into_iter().zip(figures(found));
            said.count == found.count && pairs.all(|(said, found)| near(said, found))
        }
        (None, None) => true,
        (Some(_), None) | (None, Some(_)) => false,
    }
}
