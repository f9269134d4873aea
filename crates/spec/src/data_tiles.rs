//! The finest tiles that the DEM's rectangle touches.

use std::collections::{BTreeMap, BTreeSet};

use corniche_dem::GridPlan;
use corniche_geom::{GridFrame, LatticeBounds, LatticePoint, NodeIndex, TILE_CELLS, TileId};
use corniche_tileset::pmtiles_order;

/// A rectangle of finest tiles; first and last tiles are included.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DataTiles {
    level: u8,
    /// First and last column.
    columns: [u32; 2],
    /// First and last row.
    rows: [u32; 2],
}

impl DataTiles {
    /// Returns the tiles of a plan. Nodes on a border belong to the tile in the east or south;
    /// nodes on the root's own east or south border belong to its last tiles.
    #[must_use]
    pub fn from_plan(plan: &GridPlan) -> Self {
        Self::between(&plan.frame, plan.south_west, plan.north_east)
    }

    /// The tiles that contain the nodes between two corners.
    #[must_use]
    pub fn between(frame: &GridFrame, south_west: NodeIndex, north_east: NodeIndex) -> Self {
        let corner = frame.root_corner();
        let last = (1_i64 << frame.max_level()) - 1;
        let index = |cells: i64| cells.div_euclid(TILE_CELLS).clamp(0, last) as u32;
        Self {
            level: frame.max_level(),
            columns: [south_west.i, north_east.i].map(|i| index(i - corner.i)),
            rows: [north_east.j, south_west.j].map(|j| index(corner.j - j)),
        }
    }

    /// The finest tiles from a north-western to a south-eastern one.
    #[must_use]
    pub fn spanning(first: TileId, last: TileId) -> Self {
        Self { level: first.z(), columns: [first.x(), last.x()], rows: [first.y(), last.y()] }
    }

    /// The level of these tiles: the finest one, or the level passed to [`DataTiles::above`].
    #[must_use]
    pub fn level(&self) -> u8 {
        self.level
    }

    /// Whether a tile can have data.
    #[must_use]
    pub fn contains(&self, id: TileId) -> bool {
        id.z() == self.level
            && (self.columns[0]..=self.columns[1]).contains(&id.x())
            && (self.rows[0]..=self.rows[1]).contains(&id.y())
    }

    /// The tile to which a point belongs; for a point outside the data, the nearest tile.
    #[must_use]
    pub fn owner(&self, frame: &GridFrame, point: LatticePoint) -> TileId {
        let [x, y] = frame.tile_column_row(self.level, point);
        let within =
            |at: i64, [first, last]: [u32; 2]| at.clamp(i64::from(first), i64::from(last)) as u32;
        let (x, y) = (within(x, self.columns), within(y, self.rows));
        // Columns and rows of the rectangle are always those of tiles.
        TileId::new(self.level, x, y).unwrap_or(TileId::ROOT)
    }

    /// The tiles of a coarser level above these tiles.
    #[must_use]
    pub fn above(&self, level: u8) -> Self {
        let up = self.level.saturating_sub(level);
        let raise = |ends: [u32; 2]| ends.map(|at| at >> up);
        Self { level: self.level - up, columns: raise(self.columns), rows: raise(self.rows) }
    }

    /// The tiles beneath `scope`, or `scope` itself, row by row from the north.
    #[must_use]
    pub fn within(&self, scope: TileId) -> Vec<TileId> {
        let Some(down) = self.level.checked_sub(scope.z()) else { return Vec::new() };
        let cut = |[first, last]: [u32; 2], at: u32| {
            // The last tile of the scope: in 64 bits, because a level has up to 2^32 columns.
            let end = ((u64::from(at) + 1) << down) - 1;
            first.max(at << down)..=last.min(u32::try_from(end).unwrap_or(u32::MAX))
        };
        let (columns, rows) = (cut(self.columns, scope.x()), cut(self.rows, scope.y()));
        rows.flat_map(|y| columns.clone().filter_map(move |x| TileId::new(self.level, x, y).ok()))
            .collect()
    }

    /// The tiles beneath `scope`, or `scope` itself, in package order.
    #[must_use]
    pub fn in_order_within(&self, scope: TileId) -> Vec<TileId> {
        let mut tiles = self.within(scope);
        tiles.sort_unstable_by_key(|&id| pmtiles_order(id));
        tiles
    }

    /// Returns the missing tiles, as `is_missing` reports them, among these tiles and those above
    /// them. If a whole subtree is missing, only its root is returned.
    pub fn missing(&self, is_missing: impl Fn(TileId) -> bool) -> Vec<TileId> {
        let mut level = *self;
        let mut missing: BTreeSet<TileId> =
            self.within(TileId::ROOT).into_iter().filter(|&id| is_missing(id)).collect();
        let mut largest = Vec::new();
        while level.level > 0 {
            let mut by_parent: BTreeMap<TileId, Vec<TileId>> = BTreeMap::new();
            for id in missing {
                by_parent.entry(id.ancestor(id.z() - 1)).or_default().push(id);
            }
            let all = |parent: TileId| parent.children().filter(|&id| level.contains(id)).count();
            missing = BTreeSet::new();
            for (parent, children) in by_parent {
                if children.len() == all(parent) {
                    missing.insert(parent);
                } else {
                    largest.extend(children);
                }
            }
            level = self.above(level.level - 1);
        }
        largest.extend(missing);
        largest.sort_unstable();
        largest
    }

    /// The rectangle around all these tiles.
    #[must_use]
    pub fn bounds(&self, frame: &GridFrame) -> LatticeBounds {
        let corner = |x: u32, y: u32| {
            frame.tile_lattice_bounds(TileId::new(self.level, x, y).unwrap_or(TileId::ROOT))
        };
        corner(self.columns[0], self.rows[0]).union(&corner(self.columns[1], self.rows[1]))
    }
}

#[cfg(test)]
#[path = "data_tiles_tests.rs"]
mod tests;
