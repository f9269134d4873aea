//! Heights of all levels, in blocks of 256 × 256 nodes kept in storage.
//!
//! Block `x/y` of a level holds the nodes that tile `x/y` holds, less its east and south border, which belong to
//! the next block: every node is kept once. Columns and rows run to 2^level, one beyond the tiles, for the nodes
//! on the root's own east and south border.

use std::{collections::BTreeMap, sync::Mutex, sync::PoisonError};

use corniche_dem::{Dem, DemWindow, GridPlan};
use corniche_geom::{Frame, HeightGrid, LatticeBounds, NodeIndex, NodeWindow, TILE_CELLS, TileId};
use corniche_tileset::SampleCounts;

use crate::{BuildError, Observer, Stage, Storage, storage::Kind, storage::Span, workers};

/// Nodes along one side of a block.
const BLOCK: usize = TILE_CELLS as usize;
/// Blocks along one side of what is read from the DEM at once: wide enough that the halo for filling voids is
/// small beside it, small enough (4 MB) that a worker's share of memory stays small.
const READ_BLOCKS: u32 = 4;

/// Which block: level, column, row.
type BlockId = (u8, u32, u32);

/// The level rasters of a run.
pub(crate) struct Pyramid<'a> {
    storage: &'a dyn Storage,
    blocks: BTreeMap<BlockId, Span>,
    samples: SampleCounts,
    range_m: [f32; 2],
}

/// Reads the finest level from the DEM and subsamples it level by level.
pub(crate) fn read<'a>(
    dem: &Dem,
    plan: &GridPlan,
    threads: usize,
    storage: &'a dyn Storage,
    observer: &dyn Observer,
) -> Result<Pyramid<'a>, BuildError> {
    let frame = plan.frame;
    let mut pyramid = Pyramid {
        storage,
        blocks: BTreeMap::new(),
        samples: SampleCounts::default(),
        range_m: [0.0; 2],
    };
    let areas = areas(plan);
    observer.begin(Stage::Heights, Some(areas.len() as u64));
    let mut with_height = 0;
    let mut filled = 0;
    let mut range_m: Option<[f32; 2]> = None;
    let kept = Mutex::new(BTreeMap::new());
    workers::in_order_unless_cancelled(
        observer,
        threads,
        areas.len(),
        || Ok::<_, BuildError>(dem.reader(plan)),
        |reader, index| {
            let window = reader.window(block_window(&frame, areas[index]))?;
            let mut spans = Vec::new();
            for (id, block, filled) in split(areas[index], &window, frame.max_level()) {
                spans.push((id, put(storage, &block, &filled)?));
            }
            kept.lock().unwrap_or_else(PoisonError::into_inner).extend(spans);
            Ok((window.heights.count_heights() as u64, window.filled, window.heights.range_m()))
        },
        |_, (heights, fills, area_m)| {
            range_m = match (range_m, area_m) {
                (Some(all), Some(area)) => Some([all[0].min(area[0]), all[1].max(area[1])]),
                (all, area) => all.or(area),
            };
            with_height += heights;
            filled += fills;
            observer.advance(Stage::Heights, 1);
            Ok(())
        },
    )?;
    pyramid.range_m = range_m.unwrap_or_default();
    pyramid.blocks = kept.into_inner().unwrap_or_else(PoisonError::into_inner);
    pyramid.samples = counts(plan, with_height, filled);
    for level in (0..frame.max_level()).rev() {
        pyramid.subsample(level, threads, observer)?;
    }
    observer.end(Stage::Heights);
    Ok(pyramid)
}

/// What became of the nodes of the data's rectangle.
fn counts(plan: &GridPlan, with_height: u64, filled: u64) -> SampleCounts {
    let span = |low: i64, high: i64| (high - low + 1) as u64;
    let nodes =
        span(plan.south_west.i, plan.north_east.i) * span(plan.south_west.j, plan.north_east.j);
    SampleCounts {
        nodes,
        with_data: with_height - filled,
        filled,
        void: nodes.saturating_sub(with_height),
    }
}

/// A rectangle of blocks of the finest level that is read at once: first column, first row, columns, rows.
type Area = (u32, u32, u32, u32);

/// First and last column and first and last row of the blocks that hold the data's rectangle.
fn block_range(plan: &GridPlan) -> [[u32; 2]; 2] {
    let corner = plan.frame.root_corner();
    let column = |i: i64| ((i - corner.i).div_euclid(TILE_CELLS)) as u32;
    let row = |j: i64| ((corner.j - j).div_euclid(TILE_CELLS)) as u32;
    [
        [column(plan.south_west.i), column(plan.north_east.i)],
        [row(plan.north_east.j), row(plan.south_west.j)],
    ]
}

/// The finest tiles on which the data's rectangle lies.
pub(crate) fn data_tiles(plan: &GridPlan) -> Vec<TileId> {
    let level = plan.frame.max_level();
    let [[west, east], [north, south]] = block_range(plan);
    (north..=south)
        .flat_map(|y| (west..=east).filter_map(move |x| TileId::new(level, x, y).ok()))
        .collect()
}

/// The rectangle of those tiles.
pub(crate) fn data_tile_bounds(plan: &GridPlan) -> LatticeBounds {
    let tiles = data_tiles(plan);
    // They come row by row, so the first and the last are opposite corners.
    let corner =
        |id: Option<&TileId>| plan.frame.tile_lattice_bounds(id.copied().unwrap_or(TileId::ROOT));
    corner(tiles.first()).union(&corner(tiles.last()))
}

/// The rectangles of blocks that cover the data.
fn areas(plan: &GridPlan) -> Vec<Area> {
    let [[west, east], [north, south]] = block_range(plan);
    let mut areas = Vec::new();
    for y in (north..=south).step_by(READ_BLOCKS as usize) {
        for x in (west..=east).step_by(READ_BLOCKS as usize) {
            areas.push((x, y, READ_BLOCKS.min(east - x + 1), READ_BLOCKS.min(south - y + 1)));
        }
    }
    areas
}

fn block_window(frame: &Frame, (x, y, columns, rows): Area) -> NodeWindow {
    let corner = frame.root_corner();
    NodeWindow {
        corner: NodeIndex {
            i: corner.i + i64::from(x) * TILE_CELLS,
            j: corner.j - i64::from(y) * TILE_CELLS,
        },
        stride: 1,
        columns: columns as usize * BLOCK,
        rows: rows as usize * BLOCK,
    }
}

/// The blocks of an area that hold any height.
fn split(
    (x, y, columns, rows): Area,
    window: &DemWindow,
    level: u8,
) -> impl Iterator<Item = (BlockId, HeightGrid, Vec<u16>)> + '_ {
    (0..rows).flat_map(move |r| (0..columns).map(move |c| (c, r))).filter_map(move |(c, r)| {
        let (left, top) = (c as usize * BLOCK, r as usize * BLOCK);
        let block = window.heights.window(left, top, BLOCK, BLOCK);
        let is_filled = |at: &u16| {
            let (column, row) = (usize::from(*at) % BLOCK, usize::from(*at) / BLOCK);
            window.is_filled[(top + row) * window.heights.columns() + left + column]
        };
        let filled = if window.is_filled.is_empty() {
            Vec::new()
        } else {
            (0..=u16::MAX).filter(is_filled).collect()
        };
        (block.count_heights() > 0).then_some(((level, x + c, y + r), block, filled))
    })
}

/// Bytes of a block's heights.
const BLOCK_BYTES: u64 = (BLOCK * BLOCK * 4) as u64;

/// Keeps a block's heights, and behind them which of its nodes are filled voids, by number.
fn put(storage: &dyn Storage, block: &HeightGrid, filled: &[u16]) -> Result<Span, BuildError> {
    let heights = block.raw().iter().flat_map(|height_m| height_m.to_le_bytes());
    let filled = filled.iter().flat_map(|at| at.to_le_bytes());
    let bytes: Vec<u8> = heights.chain(filled).collect();
    storage.append(Kind::Heights, &bytes).map_err(BuildError::Storage)
}

impl Pyramid<'_> {
    /// What became of the DEM's nodes.
    pub(crate) fn samples(&self) -> SampleCounts {
        self.samples
    }

    /// Lowest and highest node; zeros where there is none.
    pub(crate) fn range_m(&self) -> [f32; 2] {
        self.range_m
    }

    /// The tiles of `level` that may have ground: those that hold a height, border included.
    pub(crate) fn tiles(&self, level: u8) -> Vec<TileId> {
        let mut tiles = Vec::new();
        let mut add = |x: Option<u32>, y: Option<u32>| {
            if let (Some(x), Some(y)) = (x, y) {
                tiles.extend(TileId::new(level, x, y).ok());
            }
        };
        for &(_, x, y) in
            self.blocks.range((level, 0, 0)..=(level, u32::MAX, u32::MAX)).map(|(id, _)| id)
        {
            // A block's first column and row are also the last ones of the tiles west and north of it.
            add(Some(x), Some(y));
            add(x.checked_sub(1), Some(y));
            add(Some(x), y.checked_sub(1));
            add(x.checked_sub(1), y.checked_sub(1));
        }
        tiles.sort_unstable();
        tiles.dedup();
        tiles
    }

    /// A tile's heights on its own level, with `halo` (at most 1) more nodes on every side.
    pub(crate) fn tile(&self, id: TileId, halo: usize) -> Result<HeightGrid, BuildError> {
        let side = BLOCK + 1 + 2 * halo;
        let mut heights_m = vec![f32::NAN; side * side];
        for dy in -1..=1_i64 {
            for dx in -1..=1_i64 {
                // Where this block's nodes lie in the window; the middle block starts at `halo`.
                let start = |d: i64| d * TILE_CELLS + halo as i64;
                let (left, top) = (start(dx), start(dy));
                let clip = |from: i64| (from.max(0), (from + TILE_CELLS).min(side as i64));
                let ((c0, c1), (r0, r1)) = (clip(left), clip(top));
                let neighbour = |at: u32, d: i64| u32::try_from(i64::from(at) + d).ok();
                let (Some(x), Some(y)) = (neighbour(id.x(), dx), neighbour(id.y(), dy)) else {
                    continue;
                };
                if c0 >= c1 || r0 >= r1 {
                    continue;
                }
                let Some(&span) = self.blocks.get(&(id.z(), x, y)) else { continue };
                // Only the rows that are wanted: of the blocks north and south that is a row or two.
                let first_row = (r0 - top) as u64;
                let row_bytes = (BLOCK * 4) as u64;
                let bytes = self
                    .storage
                    .read(
                        Kind::Heights,
                        span.part(first_row * row_bytes, (r1 - r0) as u64 * row_bytes),
                    )
                    .map_err(BuildError::Storage)?;
                for (row, line) in (r0..r1).zip(bytes.chunks_exact(BLOCK * 4)) {
                    for column in c0..c1 {
                        let at = (column - left) as usize * 4;
                        let height = [line[at], line[at + 1], line[at + 2], line[at + 3]];
                        heights_m[row as usize * side + column as usize] =
                            f32::from_le_bytes(height);
                    }
                }
            }
        }
        Ok(HeightGrid::new(side, side, heights_m))
    }

    /// Which nodes of a finest tile (257 × 257, row by row from the north) are filled voids; ascending.
    pub(crate) fn filled(&self, id: TileId) -> Result<Vec<usize>, BuildError> {
        let side = BLOCK + 1;
        let mut nodes = Vec::new();
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let block = (id.z(), id.x() + dx, id.y() + dy);
            let Some(&span) = self.blocks.get(&block) else { continue };
            let filled = span.part(BLOCK_BYTES, span.length());
            let bytes = self.storage.read(Kind::Heights, filled).map_err(BuildError::Storage)?;
            nodes.extend(bytes.chunks_exact(2).filter_map(|b| {
                let at = usize::from(u16::from_le_bytes([b[0], b[1]]));
                let column = at % BLOCK + dx as usize * BLOCK;
                let row = at / BLOCK + dy as usize * BLOCK;
                (column < side && row < side).then_some(row * side + column)
            }));
        }
        nodes.sort_unstable();
        Ok(nodes)
    }

    fn block(&self, id: BlockId) -> Result<Option<HeightGrid>, BuildError> {
        let Some(&span) = self.blocks.get(&id) else { return Ok(None) };
        let heights = span.part(0, BLOCK_BYTES);
        let bytes = self.storage.read(Kind::Heights, heights).map_err(BuildError::Storage)?;
        let heights_m =
            bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
        Ok(Some(HeightGrid::new(BLOCK, BLOCK, heights_m)))
    }

    /// Makes the blocks of `level` from every second node of the level below.
    fn subsample(
        &mut self,
        level: u8,
        threads: usize,
        observer: &dyn Observer,
    ) -> Result<(), BuildError> {
        let below = (level + 1, 0, 0)..=(level + 1, u32::MAX, u32::MAX);
        let mut ids: Vec<BlockId> =
            self.blocks.range(below).map(|(&(_, x, y), _)| (level, x / 2, y / 2)).collect();
        ids.sort_unstable();
        ids.dedup();
        let mut made = Vec::new();
        workers::in_order_unless_cancelled(
            observer,
            threads,
            ids.len(),
            || Ok(()),
            |(), index| {
                let (level, x, y) = ids[index];
                let half = BLOCK / 2;
                let mut heights_m = vec![f32::NAN; BLOCK * BLOCK];
                for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    let Some(child) = self.block((level + 1, 2 * x + dx, 2 * y + dy))? else {
                        continue;
                    };
                    for row in 0..half {
                        for column in 0..half {
                            let at =
                                (row + dy as usize * half) * BLOCK + column + dx as usize * half;
                            heights_m[at] = child.raw()[2 * row * BLOCK + 2 * column];
                        }
                    }
                }
                let block = HeightGrid::new(BLOCK, BLOCK, heights_m);
                if block.count_heights() == 0 {
                    Ok(None)
                } else {
                    put(self.storage, &block, &[]).map(Some)
                }
            },
            |index, span| {
                made.extend(span.map(|span| (ids[index], span)));
                Ok(())
            },
        )?;
        self.blocks.extend(made);
        Ok(())
    }
}
