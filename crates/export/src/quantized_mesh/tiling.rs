//! The grids of terrain tiles on the globe, by degrees and by Mercator, and the names of their
//! tiles.

use std::{f64::consts::PI, fmt};

use corniche_geom::{Seam, wgs84::SEMI_MAJOR_M};

/// The largest value of u and v: they are 0 in the west and south of a tile, and have this value in
/// its east and north.
pub(crate) const LAST_STEP: u16 = 32_767;

/// The finest level that can be requested: tiles of about a metre.
pub(crate) const FINEST: u8 = 24;

/// How the globe is divided into terrain tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tiling {
    /// Squares of degrees, from two of 180° (EPSG:4326).
    Geographic,
    /// Squares of the Mercator projection, from one to 85.05° (EPSG:3857).
    WebMercator,
}

/// A tile of the globe's grid, named as in the tile map service: rows count from the south.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct TerrainTile {
    pub(crate) z: u8,
    pub(crate) x: u32,
    pub(crate) y: u32,
}

impl TerrainTile {
    pub(crate) fn parent(self) -> Option<Self> {
        (self.z > 0).then(|| Self { z: self.z - 1, x: self.x / 2, y: self.y / 2 })
    }
}

impl fmt::Display for TerrainTile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}/{}", self.z, self.x, self.y)
    }
}

impl Tiling {
    /// The CRS of the grid, with its name in layer.json.
    #[must_use]
    pub fn projection(self) -> &'static str {
        match self {
            Self::Geographic => "EPSG:4326",
            Self::WebMercator => "EPSG:3857",
        }
    }

    /// The error that CesiumJS assumes for the ground of a level, metres: that of a raster of 65 ×
    /// 65 heights.
    ///
    /// Source: CesiumJS 1.145, `TerrainProvider.getEstimatedLevelZeroGeometricErrorForAHeightmap`,
    /// halved at each level.
    #[must_use]
    pub fn level_error_m(self, level: u8) -> f64 {
        const QUALITY: f64 = 0.25;
        const RASTER: f64 = 65.0;
        let root_m = SEMI_MAJOR_M * 2.0 * PI * QUALITY / (RASTER * self.columns(0) as f64);
        root_m / f64::from(1_u32 << level)
    }

    pub(crate) fn columns(self, level: u8) -> i64 {
        match self {
            Self::Geographic => 2 << level,
            Self::WebMercator => 1 << level,
        }
    }

    fn rows(level: u8) -> i64 {
        1 << level
    }

    /// All tiles of level 0.
    pub(crate) fn roots(self) -> impl Iterator<Item = TerrainTile> {
        (0..self.columns(0) as u32).map(|x| TerrainTile { z: 0, x, y: 0 })
    }

    /// Longitude of the western edge of a column. It is exact, so neighbours agree.
    pub(crate) fn lon_deg(self, level: u8, column: i64) -> f64 {
        let columns = self.columns(level);
        (180 * (2 * column - columns)) as f64 / columns as f64
    }

    /// Latitude of the southern edge of a row.
    pub(crate) fn lat_deg(self, level: u8, row: i64) -> f64 {
        let rows = Self::rows(level);
        match self {
            Self::Geographic => (90 * (2 * row - rows)) as f64 / rows as f64,
            Self::WebMercator => {
                let y = PI * (2 * row - rows) as f64 / rows as f64;
                y.sinh().atan().to_degrees()
            }
        }
    }

    /// Column of a longitude, which may exceed ±180.
    pub(crate) fn column_of(self, level: u8, lon_deg: f64) -> i64 {
        ((lon_deg + 180.0) / 360.0 * self.columns(level) as f64).floor() as i64
    }

    /// Row of a latitude; for latitudes beyond the grid, the row of its edge.
    pub(crate) fn row_of(self, level: u8, lat_deg: f64) -> i64 {
        let share = match self {
            Self::Geographic => (lat_deg + 90.0) / 180.0,
            Self::WebMercator => f64::midpoint(lat_deg.to_radians().tan().asinh() / PI, 1.0),
        };
        ((share * Self::rows(level) as f64).floor() as i64).clamp(0, Self::rows(level) - 1)
    }

    /// Whether a tile has a horizon occlusion point, which is hidden only when the whole tile is.
    /// Tiles that are wider than half the globe have none, and are never hidden.
    pub(crate) fn has_horizon(self, tile: TerrainTile) -> bool {
        self != Self::WebMercator || tile.z > 0
    }
}

/// The degrees of a tile. u and v are fractions of steps in it.
#[derive(Clone, Copy)]
pub(crate) struct Square {
    corner_deg: [f64; 2],
    size_deg: [f64; 2],
    seam: Seam,
}

impl Square {
    /// u and v of a longitude and latitude, which may be outside the tile.
    pub(crate) fn uv_of(&self, [lon, lat]: [f64; 2]) -> [f64; 2] {
        let at = [self.seam.image(lon), lat];
        let share = |axis: usize| (at[axis] - self.corner_deg[axis]) / self.size_deg[axis];
        [0, 1].map(|axis| share(axis) * f64::from(LAST_STEP))
    }

    /// Longitude and latitude at u and v.
    pub(crate) fn place_deg(&self, uv: [f64; 2]) -> [f64; 2] {
        let share = |axis: usize| uv[axis] / f64::from(LAST_STEP);
        [0, 1].map(|axis| self.corner_deg[axis] + self.size_deg[axis] * share(axis))
    }
}

/// Whether u and v, in steps, are inside a tile or on its border.
pub(crate) fn is_in_tile(uv: [f64; 2]) -> bool {
    uv.iter().all(|step| (0.0..=f64::from(LAST_STEP)).contains(step))
}

/// The places of a level's rasters: a grid of nodes over the globe, with the same number along each
/// side of a tile.
///
/// ```text
///   node k of a tile, 0 to n      u = k · 32767 / n, rounded      node n of a tile is node 0 of the next
/// ```
///
/// Nodes are at possible values of u and v, so no vertex moves when it is written. Longitude and
/// latitude are linear in u and v, also in Mercator tiles.
#[derive(Clone, Copy)]
pub(crate) struct RasterNodes {
    pub(crate) tiling: Tiling,
    pub(crate) level: u8,
    /// Cells along each side of a tile.
    pub(crate) per_tile: i64,
    /// Parts of a cell in each direction: at their ends the ground is sampled on borders and
    /// outlines.
    pub(crate) parts: i64,
}

impl RasterNodes {
    /// u or v of a node of a tile.
    pub(crate) fn step(self, node: i64) -> u16 {
        ((2 * node * i64::from(LAST_STEP) + self.per_tile) / (2 * self.per_tile)) as u16
    }

    /// The position of node `node` across a tile, from 0 to 1.
    pub(crate) fn share(self, node: i64) -> f64 {
        f64::from(self.step(node)) / f64::from(LAST_STEP)
    }

    /// Longitude of a column of nodes; columns are counted over the globe and around it.
    pub(crate) fn lon_deg(self, i: i64) -> f64 {
        let Self { tiling, level, per_tile, .. } = self;
        let column = i.div_euclid(per_tile).rem_euclid(tiling.columns(level));
        let [west, east] = [column, column + 1].map(|column| tiling.lon_deg(level, column));
        west + (east - west) * self.share(i.rem_euclid(per_tile))
    }

    /// Latitude of a row of nodes, counted from the south; beyond the grid, the latitude of its
    /// edge.
    pub(crate) fn lat_deg(self, j: i64) -> f64 {
        let Self { tiling, level, per_tile, .. } = self;
        let j = j.clamp(0, Tiling::rows(level) * per_tile);
        let row = j.div_euclid(per_tile);
        let [south, north] = [row, row + 1].map(|row| tiling.lat_deg(level, row));
        south + (north - south) * self.share(j.rem_euclid(per_tile))
    }

    /// Longitudes and latitudes of a rectangle of nodes, given by its south-western and
    /// north-eastern node, row by row from the south.
    pub(crate) fn places_deg(
        self,
        [west, south]: [i64; 2],
        [east, north]: [i64; 2],
    ) -> Vec<[f64; 2]> {
        let lons: Vec<f64> = (west..=east).map(|i| self.lon_deg(i)).collect();
        let lats = (south..=north).map(|j| self.lat_deg(j));
        lats.flat_map(|lat| lons.iter().map(move |&lon| [lon, lat])).collect()
    }

    /// Longitude and latitude of a tile's south-western and north-eastern corner.
    pub(crate) fn corners_deg(self, tile: TerrainTile) -> [[f64; 2]; 2] {
        [0, 1].map(|beside| {
            let [x, y] = [tile.x, tile.y].map(|index| i64::from(index) + beside);
            [self.tiling.lon_deg(self.level, x), self.tiling.lat_deg(self.level, y)]
        })
    }

    /// Longitude and latitude at u and v of a tile. On a border they are identical for both tiles,
    /// to the last bit.
    pub(crate) fn place_deg(self, tile: TerrainTile, [u, v]: [u16; 2]) -> [f64; 2] {
        let [from, to] = self.corners_deg(tile);
        // Common places of two tiles are identical in both.
        let of = |axis: usize, step: u16, index: u32, node_deg: fn(Self, i64) -> f64| {
            if step == LAST_STEP {
                return node_deg(self, (i64::from(index) + 1) * self.per_tile);
            }
            from[axis] + (to[axis] - from[axis]) * f64::from(step) / f64::from(LAST_STEP)
        };
        [of(0, u, tile.x, Self::lon_deg), of(1, v, tile.y, Self::lat_deg)]
    }

    /// The square of degrees of a tile.
    pub(crate) fn square_of(self, tile: TerrainTile) -> Square {
        let [[west, south], [east, north]] = self.corners_deg(tile);
        let seam = Seam::of_degrees().around(f64::midpoint(west, east));
        Square { corner_deg: [west, south], size_deg: [east - west, north - south], seam }
    }

    /// The cell along a side that contains u or v.
    pub(crate) fn cell_of(self, step: u16) -> i64 {
        let guess = i64::from(step) * self.per_tile / i64::from(LAST_STEP);
        let cell = if self.step(guess) > step { guess - 1 } else { guess };
        cell.clamp(0, self.per_tile - 1)
    }

    /// Returns the places inside a cell at which its parts meet. The cell is given by its column
    /// and its row from the south.
    pub(crate) fn inside_cell(self, cell: [usize; 2]) -> impl Iterator<Item = [u16; 2]> {
        let at = move |axis: usize, part: i64| self.part_of_cell(cell[axis] as i64, part);
        let inner = 1..self.parts;
        inner.clone().flat_map(move |row| inner.clone().map(move |c| [at(0, c), at(1, row)]))
    }

    fn part_of_cell(self, cell: i64, part: i64) -> u16 {
        let [from, to] = [cell, cell + 1].map(|node| i64::from(self.step(node)));
        (from + (to - from) * part / self.parts) as u16
    }

    /// Steps from a border's start to its end, with this number of parts to a cell.
    pub(crate) fn border_steps(self) -> Vec<u16> {
        let inside = 0..self.per_tile * self.parts;
        let mut steps: Vec<u16> =
            inside.map(|k| self.part_of_cell(k / self.parts, k % self.parts)).collect();
        steps.push(LAST_STEP);
        steps
    }

    /// Returns the grid one level up, with cells twice as wide.
    pub(crate) fn above(self) -> Option<Self> {
        (self.level > 0).then(|| Self { level: self.level - 1, ..self })
    }
}

#[cfg(test)]
#[path = "tiling_tests.rs"]
mod tests;
