//! A block of a raster: heights of TINs at its nodes, and their differences from the elevation
//! files.

use std::{
    collections::HashMap,
    sync::{Arc, Mutex},
};

use corniche_dem::HeightReader;
use corniche_geom::{NodeWindow, TILE_CELLS, TileId};
use corniche_tileset::{FilePackage, SampleSums, Sections, TileTerrain};
use corniche_tin::{TriangleBuckets, WindowPlacement, heights_m};
use corniche_work::locked;

use super::{file::Pixel, grid::BLOCK};
use crate::error::{ElevationError, RasterError, TileError};

/// A block in the form in which it is written: 256 × 256 nodes, including those beyond the raster.
pub(crate) struct RasterBlock<T> {
    /// Heights of TINs; NaN where there is no ground.
    pub(crate) heights_m: Vec<T>,
    /// TIN minus DEM; NaN if one of both is missing. Empty without elevation files.
    pub(crate) errors_m: Vec<T>,
    /// Nodes with ground.
    pub(crate) covered: u64,
    /// Distances of the TINs from samples, counted as in a build.
    pub(crate) sums: SampleSums,
}

/// The TINs of a level, cached for neighbouring blocks.
pub(crate) struct Tins<'a> {
    package: &'a FilePackage,
    level: u8,
    kept: Mutex<HashMap<TileId, Slot>>,
}

/// A tile's slot in the cache, empty until the tile is read. Other threads that need the tile wait,
/// so each tile is read once.
type Slot = Arc<Mutex<Option<Arc<Option<TriangleBuckets>>>>>;

impl<'a> Tins<'a> {
    pub(crate) fn new(package: &'a FilePackage, level: u8) -> Self {
        Self { package, level, kept: Mutex::default() }
    }

    /// Removes tiles that end north of a row of nodes from the cache.
    pub(crate) fn forget_north_of(&self, j: i64) {
        let frame = &self.package.manifest().frame;
        let side = TILE_CELLS * frame.stride(self.level);
        let mut kept = locked(&self.kept);
        kept.retain(|id, _| frame.tile_corner(*id).j - side <= j);
    }

    /// Returns the triangles of a tile; `None` if the package has no ground there.
    fn of_tile(&self, id: TileId) -> Result<Arc<Option<TriangleBuckets>>, TileError> {
        let slot = Arc::clone(locked(&self.kept).entry(id).or_default());
        let mut slot = locked(&slot);
        if let Some(known) = &*slot {
            return Ok(Arc::clone(known));
        }
        let quantum_m = self.package.manifest().vertical.quantum_m;
        let payload = self.package.payload(id, Sections::TERRAIN)?;
        let terrain = payload.and_then(|payload| payload.terrain);
        let buckets = |terrain: TileTerrain| TriangleBuckets::new(&terrain.tin, quantum_m);
        let found = Arc::new(terrain.map(buckets));
        *slot = Some(Arc::clone(&found));
        Ok(found)
    }

    /// Returns the ground at the nodes of a window of stride 1.
    fn heights(&self, window: &NodeWindow) -> Result<Heights, TileError> {
        let frame = &self.package.manifest().frame;
        let (root, stride) = (frame.root_corner(), frame.stride(self.level));
        let (side, last) = (TILE_CELLS * stride, (1_i64 << self.level) - 1);
        // A node on a border is in two tiles.
        let tiles = |from: i64, nodes: usize| {
            let first = (from - 1).div_euclid(side).clamp(0, last);
            let end = (from + nodes as i64 - 1).div_euclid(side).clamp(0, last);
            (first..=end).rev()
        };
        let from = [window.corner.i - root.i, root.j - window.corner.j];
        let own_tile = |from: i64, node: usize| (from + node as i64).div_euclid(side).min(last);
        let nodes = window.columns * window.rows;
        let mut found = Heights { heights_m: vec![f64::NAN; nodes], is_own: vec![false; nodes] };
        for y in tiles(from[1], window.rows) {
            for x in tiles(from[0], window.columns) {
                let Ok(id) = TileId::new(self.level, x as u32, y as u32) else { continue };
                let tile = self.of_tile(id)?;
                let Some(buckets) = tile.as_ref() else { continue };
                let placement =
                    WindowPlacement { column: from[0] - x * side, row: from[1] - y * side, stride };
                let own = heights_m(buckets, [window.columns, window.rows], placement);
                for (place, height_m) in own.into_iter().enumerate() {
                    if found.heights_m[place].is_nan() && !height_m.is_nan() {
                        let (column, row) = (place % window.columns, place / window.columns);
                        found.heights_m[place] = height_m;
                        found.is_own[place] =
                            [own_tile(from[0], column), own_tile(from[1], row)] == [x, y];
                    }
                }
            }
        }
        Ok(found)
    }
}

/// Heights at the nodes of a window, row by row.
struct Heights {
    /// NaN where there is no ground. Nodes on a border have the height of the tile in the east or
    /// south if it has ground there.
    heights_m: Vec<f64>,
    /// Whether a node has ground in the tile that counts it in its figures: of two tiles, the one
    /// in the east or south.
    is_own: Vec<bool>,
}

/// Computes the block of a window; `pixel` converts heights.
pub(crate) fn make<T: Pixel>(
    tins: &Tins<'_>,
    window: &NodeWindow,
    reader: Option<&mut HeightReader<'_>>,
    pixel: fn(f64) -> T,
) -> Result<RasterBlock<T>, RasterError> {
    let Heights { heights_m, is_own } = tins.heights(window)?;
    let quantum_m = tins.package.manifest().vertical.quantum_m;
    let covered = heights_m.iter().filter(|height_m| !height_m.is_nan()).count() as u64;
    let mut sums = SampleSums::new(quantum_m);
    let mut errors_m = Vec::new();
    if let Some(reader) = reader {
        let read = reader.window(*window).map_err(ElevationError::from)?;
        let samples = read.heights.raw().iter().enumerate();
        let own = samples.zip(&heights_m).map(|((place, &sample_m), &height_m)| {
            // A filled void is not a sample.
            if sample_m.is_nan() || read.is_filled.get(place) == Some(&true) {
                return f64::NAN;
            }
            let error_m = height_m - f64::from(sample_m);
            sums.add(is_own[place].then_some(error_m.abs()));
            error_m
        });
        errors_m = whole(&own.collect::<Vec<f64>>(), window, pixel);
    }
    Ok(RasterBlock { heights_m: whole(&heights_m, window, pixel), errors_m, covered, sums })
}

/// Extends the numbers of a window to a whole block.
fn whole<T: Pixel>(numbers: &[f64], window: &NodeWindow, pixel: fn(f64) -> T) -> Vec<T> {
    let mut block = vec![pixel(f64::NAN); BLOCK * BLOCK];
    for (from, to) in numbers.chunks(window.columns).zip(block.chunks_mut(BLOCK)) {
        for (from, to) in from.iter().zip(to) {
            *to = pixel(*from);
        }
    }
    block
}
