//! A patch: the tiles whose heights are read from the DEM at once.
//!
//! ```text
//!  DEM ─► samples checked ───► window of nodes ─► heights of finest tiles
//!                                             └─► rasters of the two levels above
//! ```
//!
//! A patch is a tile two levels above the finest, so its window has at most 1027 × 1027 nodes (4
//! MB), and the halo for filling voids is small in comparison.

use corniche_dem::{AuditBlock, AuditPart, Auditor, Dem, DemWindow, GridPlan, HeightReader};
use corniche_geom::{GridFrame, HeightGrid, NodeIndex, NodeWindow, TILE_CELLS, TILE_NODES, TileId};
use corniche_spec::{
    artifacts::{self, ArtifactKind},
    data_tiles::DataTiles,
};
use corniche_store::Artifacts;
use serde::{Deserialize, Serialize};

use super::{
    finest::{FinestHeights, HALO, own_size},
    rasters,
};
use crate::GroundError;

/// Levels from a patch down to the finest.
const PATCH_LEVELS: u8 = 2;

/// The level of patches beneath or at `scope`.
pub(crate) fn patch_level(frame: &GridFrame, scope: TileId) -> u8 {
    frame.max_level().saturating_sub(PATCH_LEVELS).max(scope.z())
}

/// The record of a patch whose heights were read. Records can be merged in any order.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PatchRecord {
    /// Nodes that have a height; each node of the data belongs to one patch.
    pub(crate) with_height: u64,
    /// How many of the nodes are filled voids.
    pub filled: u64,
    /// Lowest and highest height, metres; `None` without any.
    pub range_m: Option<[f32; 2]>,
    /// The findings about samples, one part for each file.
    pub(crate) audit: Vec<AuditPart>,
}

impl PatchRecord {
    /// Adds another patch's record.
    pub fn merge(&mut self, other: Self) {
        self.with_height += other.with_height;
        self.filled += other.filled;
        self.range_m = union(self.range_m, other.range_m);
        other.audit.into_iter().for_each(|part| merge_audit(&mut self.audit, part));
    }

    /// Reads the record of a patch; `None` if the patch is not done.
    ///
    /// # Errors
    /// See [`GroundError`].
    pub fn get(store: &dyn Artifacts, patch: TileId) -> Result<Option<Self>, GroundError> {
        Ok(artifacts::get(store, ArtifactKind::Patch.of_tile(patch))?)
    }
}

/// The union of two ranges.
#[must_use]
pub fn union(a: Option<[f32; 2]>, b: Option<[f32; 2]>) -> Option<[f32; 2]> {
    match (a, b) {
        (Some(a), Some(b)) => Some([a[0].min(b[0]), a[1].max(b[1])]),
        (a, b) => a.or(b),
    }
}

/// Merges a part into the part of the same file.
fn merge_audit(parts: &mut Vec<AuditPart>, part: AuditPart) {
    let mut left = Some(part);
    for own in parts.iter_mut() {
        left = left.and_then(|part| own.merge(part));
    }
    parts.extend(left);
}

/// Assigns blocks of samples to the patches that check them: each block belongs to the patch that
/// contains its centre, or the nearest one.
pub(crate) fn audit_blocks_of(
    dem: &Dem,
    plan: &GridPlan,
    patch_level: u8,
) -> Result<Vec<(TileId, AuditBlock)>, GroundError> {
    let data = DataTiles::from_plan(plan);
    let mut blocks = Vec::new();
    for block in dem.audit_blocks(plan)? {
        let middle_m = dem.audit_block_middle_m(&block, plan)?;
        let point = plan.frame.snap(middle_m).unwrap_or_else(|| data.bounds(&plan.frame).min);
        blocks.push((data.owner(&plan.frame, point).ancestor(patch_level), block));
    }
    blocks.sort_by_key(|&(patch, _)| patch);
    Ok(blocks)
}

/// Reads one patch after the other; each thread has its own reader.
pub(crate) struct PatchReader<'a> {
    reader: HeightReader<'a>,
    auditor: Auditor<'a>,
    plan: &'a GridPlan,
    store: &'a dyn Artifacts,
}

impl<'a> PatchReader<'a> {
    /// Creates a reader; `allowed_m` are the lowest and the highest height that samples may have.
    pub(crate) fn new(
        dem: &'a Dem,
        plan: &'a GridPlan,
        allowed_m: [f64; 2],
        store: &'a dyn Artifacts,
    ) -> Self {
        Self { reader: dem.reader(plan), auditor: dem.auditor(allowed_m), plan, store }
    }

    /// Checks the samples of `blocks`, reads the patch's heights and stores them, with those of the
    /// levels above up to the patch's own level. Stores the record last.
    pub(crate) fn make(&mut self, patch: TileId, blocks: &[AuditBlock]) -> Result<(), GroundError> {
        let mut record = PatchRecord::default();
        for block in blocks {
            merge_audit(&mut record.audit, self.auditor.look(block)?);
        }
        let frame = self.plan.frame;
        let tiles = DataTiles::from_plan(self.plan).within(patch);
        if let (Some(&first), Some(&last)) = (tiles.first(), tiles.last()) {
            let window = self.reader.window(window_of(&frame, first, last))?;
            for &id in &tiles {
                let (left, top) = place([first.x(), first.y()], id);
                match FinestHeights::cut(&window, left, top) {
                    Some(heights) => heights.put(self.store, id)?,
                    None => FinestHeights::put_none(self.store, id)?,
                }
                record.count(&window, id, [left, top]);
            }
            self.put_rasters(patch, first, &window)?;
        }
        Ok(artifacts::put(self.store, ArtifactKind::Patch.of_tile(patch), &record)?)
    }

    /// Stores the rasters of the levels from the one above the finest up to the patch's level,
    /// taken from the window that begins with `first`.
    fn put_rasters(
        &self,
        patch: TileId,
        first: TileId,
        window: &DemWindow,
    ) -> Result<(), GroundError> {
        let frame = self.plan.frame;
        let data = DataTiles::from_plan(self.plan);
        let heights = &window.heights;
        for level in patch.z()..frame.max_level() {
            let stride = frame.stride(level);
            for id in data.above(level).within(patch) {
                let (own, window_corner) = (frame.tile_corner(id), frame.tile_corner(first));
                // The window starts with the halo of the tile `first`.
                let halo = HALO as i64;
                let (left, top) = (own.i - window_corner.i + halo, window_corner.j - own.j + halo);
                let at = |from: i64, index: usize, nodes: usize| {
                    usize::try_from(from + index as i64 * stride).ok().filter(|&at| at < nodes)
                };
                let raster = HeightGrid::from_fn(TILE_NODES, TILE_NODES, |column, row| {
                    let column = at(left, column, heights.columns());
                    let row = at(top, row, heights.rows());
                    let height_m = column.zip(row).and_then(|(c, r)| heights.height(c, r));
                    height_m.unwrap_or(f32::NAN)
                });
                rasters::put(self.store, id, &raster)?;
            }
        }
        Ok(())
    }
}

impl PatchRecord {
    /// Counts the nodes that belong to a tile.
    fn count(&mut self, window: &DemWindow, id: TileId, [left, top]: [usize; 2]) {
        let [columns, rows] = own_size(id);
        let own = window.heights.window(left, top, columns, rows);
        self.with_height += own.count_heights() as u64;
        self.range_m = union(self.range_m, own.range_m());
        if !window.is_filled.is_empty() {
            for row in top..top + rows {
                let from = row * window.heights.columns() + left;
                let filled = &window.is_filled[from..from + columns];
                self.filled += filled.iter().filter(|&&filled| filled).count() as u64;
            }
        }
    }
}

/// The nodes from one finest tile to another, with borders and halo.
fn window_of(frame: &GridFrame, first: TileId, last: TileId) -> NodeWindow {
    let NodeIndex { i, j } = frame.tile_corner(first);
    let side = |first: u32, last: u32| (last - first + 1) as usize * TILE_CELLS as usize + 1;
    NodeWindow {
        corner: NodeIndex { i, j },
        stride: 1,
        columns: side(first.x(), last.x()),
        rows: side(first.y(), last.y()),
    }
    .with_halo(HALO)
}

/// Column and row of a tile's north-west node in the window that begins with the tile at `first`.
fn place(first: [u32; 2], id: TileId) -> (usize, usize) {
    let nodes = |first: u32, at: u32| (at - first) as usize * TILE_CELLS as usize + HALO;
    (nodes(first[0], id.x()), nodes(first[1], id.y()))
}
