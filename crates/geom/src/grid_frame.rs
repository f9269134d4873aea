//! The global grid of a package: its tiles, its lattice, and the conversions between them and
//! working metres.

use serde::{Deserialize, Serialize};

use crate::node::{NodeIndex, NodeWindow};
use crate::tile_size::{MAX_LEVEL, TILE_CELLS, TILE_NODES};
use crate::{Bounds, Cell, LatticeBounds, LatticePoint, TileId};

/// The limit of node indices, so that they and their differences fit in the types in which they are
/// stored.
const MAX_INDEX: i64 = 1 << 32;
/// The limit of lattice coordinates, about 500 million km: an f64 is still exact to an eighth of a
/// step, which the positions of crossings need, and products of two differences are far below the
/// limit of 128 bits.
pub const MAX_LATTICE_STEPS: i64 = 1 << 50;
/// The limit of positions in working metres: lattice points are within [`MAX_LATTICE_STEPS`] steps
/// of at most a millimetre of the grid's origin, which is within a cell of zero. The limit is twice
/// that distance.
pub const MAX_COORDINATE_M: f64 = 2.0 * (MAX_LATTICE_STEPS as f64) * 0.001;

/// Why numbers cannot form a [`GridFrame`].
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GridFrameError {
    /// The cell's sides have unusable lengths.
    #[error("a cell of {cell} is not usable; its sides must be between 0.001 m and 1000 km")]
    Cell {
        /// The requested cell.
        cell: Cell,
    },
    /// The cell's east side is not a whole number of lattice steps.
    #[error("a cell of {cell} does not fit the lattice: its east side is {steps} lattice steps")]
    EastSide {
        /// The cell given.
        cell: Cell,
        /// The length of its east side in lattice steps.
        steps: f64,
    },
    /// The origin is not finite.
    #[error("the grid origin {origin_m:?} is not a position")]
    Origin {
        /// The requested origin.
        origin_m: [f64; 2],
    },
    /// The extent needs more levels than a package can have, or is too far from the origin.
    #[error("{columns} × {rows} cells of {cell} are too many for one package; use a larger --cell")]
    Extent {
        /// Cells from west to east.
        columns: i64,
        /// Cells from south to north.
        rows: i64,
        /// The cell.
        cell: Cell,
    },
    /// The corner of the root is not on a whole tile.
    #[error("the root tile's corner ({}, {}) is not a multiple of {TILE_CELLS} cells", corner.i, corner.j)]
    Corner {
        /// The corner given.
        corner: NodeIndex,
    },
}

/// The global grid of a package, its tiles and its lattice, in working metres: the CRS's
/// coordinates, each multiplied by a factor that the package records.
///
/// ```text
///   root corner (node i0, j0)            x = origin_x + cell_east · i     i grows east
///     o──────────┬──────────► x          y = origin_y + cell_north · j    j grows north
///     │ z/0/0    │ z/1/0                 u = i · steps_east, v = j · 2^bits
///     ├──────────┼──────────
///     │ z/0/1    │ z/1/1                 a tile: 256 cells of its level
///     ▼ tile row y                       a lattice step: cell_north / 2^bits = cell_east / steps_east
/// ```
///
/// Cells are rectangles, the lattice is square.
///
/// Positions are computed from the global integer indices, by the two formulas above and in no
/// other way: the last bit of `tile_min + k · cell` would differ between neighbours. The origin is
/// the grid's phase (within one cell of CRS zero), so adjoining regions of one product get the same
/// nodes and the same tile borders.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "GridFrameRecord")]
pub struct GridFrame {
    origin_m: [f64; 2],
    #[serde(rename = "cell_m")]
    cell: Cell,
    root_corner: NodeIndex,
    max_level: u8,
    /// Lattice steps per cell, east and north. They follow from the cell.
    #[serde(skip_serializing)]
    steps: [i64; 2],
}

/// The serialised form of [`GridFrame`].
#[derive(Deserialize)]
struct GridFrameRecord {
    origin_m: [f64; 2],
    cell_m: Cell,
    root_corner: NodeIndex,
    max_level: u8,
}

impl TryFrom<GridFrameRecord> for GridFrame {
    type Error = GridFrameError;

    fn try_from(record: GridFrameRecord) -> Result<Self, GridFrameError> {
        Self::new(record.origin_m, record.cell_m, record.root_corner, record.max_level)
    }
}

impl GridFrame {
    /// Creates a frame from its parts, as a package records them.
    ///
    /// # Errors
    /// When the parts are out of range, the corner is not on a whole tile, or the cell's east side
    /// is not a whole number of lattice steps ([`Cell::fitted`] makes it one).
    pub fn new(
        origin_m: [f64; 2],
        cell: impl Into<Cell>,
        root_corner: NodeIndex,
        max_level: u8,
    ) -> Result<Self, GridFrameError> {
        let cell = cell.into();
        if !cell.is_usable() {
            return Err(GridFrameError::Cell { cell });
        }
        if !origin_m.iter().all(|metres| metres.is_finite()) {
            return Err(GridFrameError::Origin { origin_m });
        }
        let span = TILE_CELLS << max_level.min(MAX_LEVEL);
        let reach =
            root_corner.i.saturating_abs().max(root_corner.j.saturating_abs()).saturating_add(span);
        if max_level > MAX_LEVEL || reach > MAX_INDEX {
            return Err(GridFrameError::Extent { columns: span, rows: span, cell });
        }
        if root_corner.i % TILE_CELLS != 0 || root_corner.j % TILE_CELLS != 0 {
            return Err(GridFrameError::Corner { corner: root_corner });
        }
        let steps_east = cell.east_m / cell.lattice_step_m();
        if cell.fitted().east_m.to_bits() != cell.east_m.to_bits() {
            return Err(GridFrameError::EastSide { cell, steps: steps_east });
        }
        let steps = [steps_east.round() as i64, 1 << cell.lattice_bits()];
        if steps.iter().any(|&steps| reach > MAX_LATTICE_STEPS / steps) {
            return Err(GridFrameError::Extent { columns: span, rows: span, cell });
        }
        Ok(Self { origin_m, cell, root_corner, max_level, steps })
    }

    /// Returns the smallest frame whose root covers all nodes from `south_west` to `north_east`,
    /// both included.
    ///
    /// # Errors
    /// When this takes more levels than a package can have.
    pub fn covering(
        origin_m: [f64; 2],
        cell: impl Into<Cell>,
        south_west: NodeIndex,
        north_east: NodeIndex,
    ) -> Result<Self, GridFrameError> {
        let cell = cell.into();
        let down = |index: i64| index.div_euclid(TILE_CELLS);
        // A border node belongs to both tiles; one tile is enough for an extent that ends on a
        // border.
        let up = |index: i64| {
            index.div_euclid(TILE_CELLS) + i64::from(index.rem_euclid(TILE_CELLS) != 0)
        };
        let (west, south) = (down(south_west.i), down(south_west.j));
        let (east, north) = (up(north_east.i).max(west + 1), up(north_east.j).max(south + 1));
        let tiles = (east - west).max(north - south);
        let mut max_level = 0;
        while 1_i64 << max_level < tiles {
            max_level += 1;
            if max_level > MAX_LEVEL {
                let (columns, rows) = (north_east.i - south_west.i, north_east.j - south_west.j);
                return Err(GridFrameError::Extent { columns, rows, cell });
            }
        }
        Self::new(
            origin_m,
            cell,
            NodeIndex { i: west * TILE_CELLS, j: north * TILE_CELLS },
            max_level,
        )
    }

    /// The position of node (0, 0).
    #[must_use]
    pub fn origin_m(&self) -> [f64; 2] {
        self.origin_m
    }

    /// The cell of the finest level: the spacing of its nodes.
    #[must_use]
    pub fn cell(&self) -> Cell {
        self.cell
    }

    /// The finest level.
    #[must_use]
    pub fn max_level(&self) -> u8 {
        self.max_level
    }

    /// The north-west node of tile 0/0/0.
    #[must_use]
    pub fn root_corner(&self) -> NodeIndex {
        self.root_corner
    }

    /// The number of lattice steps from one node of a level to the next, east and north.
    ///
    /// # Panics
    /// When `level` is beyond the finest level.
    #[must_use]
    pub fn node_steps(&self, level: u8) -> [i64; 2] {
        self.steps.map(|steps| steps * self.stride(level))
    }

    /// The length of a lattice step: at most a millimetre.
    #[must_use]
    pub fn lattice_step_m(&self) -> f64 {
        self.cell.lattice_step_m()
    }

    /// The spacing of a level's nodes in finest cells.
    ///
    /// # Panics
    /// When `level` is beyond the finest level.
    #[must_use]
    pub fn stride(&self, level: u8) -> i64 {
        assert!(level <= self.max_level, "level {level} of {}", self.max_level);
        1 << (self.max_level - level)
    }

    /// The cell of a level.
    ///
    /// # Panics
    /// When `level` is beyond the finest level.
    #[must_use]
    pub fn level_cell(&self, level: u8) -> Cell {
        self.cell.times(self.stride(level) as f64)
    }

    /// The x of every node with index `i`.
    #[must_use]
    pub fn x_m(&self, i: i64) -> f64 {
        self.origin_m[0] + self.cell.east_m * i as f64
    }

    /// The y of every node with index `j`.
    #[must_use]
    pub fn y_m(&self, j: i64) -> f64 {
        self.origin_m[1] + self.cell.north_m * j as f64
    }

    /// The lattice point of a node.
    #[must_use]
    pub fn lattice_of_node(&self, node: NodeIndex) -> LatticePoint {
        LatticePoint::new(node.i * self.steps[0], node.j * self.steps[1])
    }

    /// The rectangle between a south-western and a north-eastern node, on the lattice.
    #[must_use]
    pub fn lattice_bounds(&self, nodes: [NodeIndex; 2]) -> LatticeBounds {
        let [min, max] = nodes.map(|node| self.lattice_of_node(node));
        LatticeBounds { min, max }
    }

    /// The rectangle between a south-western and a north-eastern node, in working metres.
    #[must_use]
    pub fn node_bounds_m(&self, [south_west, north_east]: [NodeIndex; 2]) -> Bounds {
        Bounds {
            min_x: self.x_m(south_west.i),
            min_y: self.y_m(south_west.j),
            max_x: self.x_m(north_east.i),
            max_y: self.y_m(north_east.j),
        }
    }

    /// The position of a lattice point; for a node's point the same bits as [`GridFrame::x_m`] and
    /// [`GridFrame::y_m`].
    #[must_use]
    pub fn position_m(&self, point: LatticePoint) -> [f64; 2] {
        self.position_of_fraction_m([point.u as f64, point.v as f64])
    }

    /// The position of a point between lattice points, which is given in lattice steps.
    #[must_use]
    pub fn position_of_fraction_m(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let [east, north] = self.steps.map(|steps| steps as f64);
        [
            self.origin_m[0] + self.cell.east_m * (u / east),
            self.origin_m[1] + self.cell.north_m * (v / north),
        ]
    }

    /// Converts a position to lattice steps: the inverse of [`GridFrame::position_of_fraction_m`].
    #[must_use]
    pub fn fraction_of_position(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [east, north] = self.steps.map(|steps| steps as f64);
        [
            (x - self.origin_m[0]) / self.cell.east_m * east,
            (y - self.origin_m[1]) / self.cell.north_m * north,
        ]
    }

    /// Returns the lattice point nearest to a position; `None` if the position is not finite or
    /// beyond the lattice's limit.
    #[must_use]
    pub fn snap(&self, position: [f64; 2]) -> Option<LatticePoint> {
        let [u, v] = self.fraction_of_position(position).map(|steps| {
            let steps = steps.round();
            // With NaN the comparison is false, too.
            (steps.abs() < MAX_LATTICE_STEPS as f64).then_some(steps as i64)
        });
        Some(LatticePoint::new(u?, v?))
    }

    /// The north-west node of a tile.
    ///
    /// # Panics
    /// When the tile's level is beyond the finest level.
    #[must_use]
    pub fn tile_corner(&self, id: TileId) -> NodeIndex {
        let side = TILE_CELLS * self.stride(id.z());
        NodeIndex {
            i: self.root_corner.i + side * i64::from(id.x()),
            j: self.root_corner.j - side * i64::from(id.y()),
        }
    }

    /// The nodes of a tile on its own level: 257 × 257.
    #[must_use]
    pub fn tile_window(&self, id: TileId) -> NodeWindow {
        NodeWindow {
            corner: self.tile_corner(id),
            stride: self.stride(id.z()),
            columns: TILE_NODES,
            rows: TILE_NODES,
        }
    }

    /// The rectangle of a tile on the lattice.
    #[must_use]
    pub fn tile_lattice_bounds(&self, id: TileId) -> LatticeBounds {
        self.lattice_bounds(self.tile_ends(id))
    }

    /// The rectangle of a tile in the working CRS.
    #[must_use]
    pub fn tile_bounds(&self, id: TileId) -> Bounds {
        self.node_bounds_m(self.tile_ends(id))
    }

    /// The south-western and the north-eastern node of a tile.
    fn tile_ends(&self, id: TileId) -> [NodeIndex; 2] {
        let NodeIndex { i, j } = self.tile_corner(id);
        let side = TILE_CELLS * self.stride(id.z());
        [NodeIndex { i, j: j - side }, NodeIndex { i: i + side, j }]
    }

    /// The column and the row of the tile of `level` that contains a lattice point (the
    /// south-eastern tile on a border); outside 0…2^level − 1 if the point is outside the root.
    #[must_use]
    pub fn tile_column_row(&self, level: u8, point: LatticePoint) -> [i64; 2] {
        let corner = self.lattice_of_node(self.root_corner);
        let [east, north] = self.node_steps(level).map(|steps| TILE_CELLS * steps);
        [(point.u - corner.u).div_euclid(east), (corner.v - point.v).div_euclid(north)]
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these numbers are exact")]
#[path = "grid_frame_tests.rs"]
mod tests;
