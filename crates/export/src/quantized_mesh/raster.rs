//! A raster of heights for each tile, with one more node on each side, including places without
//! ground. In this module, a node is a point of the raster.

use super::{
    facets::MeshVertex,
    ground::GroundReader,
    tiling::{LAST_STEP, RasterNodes, TerrainTile},
};
use crate::{
    error::QuantizedMeshError,
    globe::{between, cross, dot, geocentric_m, unit, up_at},
};

/// Places far from all ground are on the ellipsoid, like the globe of a viewer without terrain.
const FAR_FROM_GROUND_M: f64 = 0.0;

/// The heights of a tile. Row 0 and column 0 belong to the neighbours in the north and the west.
pub(crate) struct HeightRaster {
    pub(crate) nodes: RasterNodes,
    tile: TerrainTile,
    /// Longitudes of columns, from the west.
    lon_deg: Vec<f64>,
    /// Latitudes of rows, from the north.
    pub(crate) lat_deg: Vec<f64>,
    pub(crate) heights_m: Vec<f64>,
    /// Whether there is ground, rather than a height filled in.
    is_ground: Vec<bool>,
}

/// A rectangle of the nodes of a level, with one more node on each side.
struct Window {
    nodes: RasterNodes,
    /// Column and row of the south-western node, rows counted from the south, without the nodes
    /// around.
    from: [i64; 2],
    to: [i64; 2],
    /// Row by row from the south, including the nodes around; NaN where there is no ground.
    heights_m: Vec<f64>,
}

impl Window {
    fn sample(
        nodes: RasterNodes,
        from: [i64; 2],
        to: [i64; 2],
        ground: &GroundReader<'_>,
    ) -> Result<Self, QuantizedMeshError> {
        let [first, last] = around(from, to);
        let heights_m = ground.heights_m(&nodes.places_deg(first, last))?;
        Ok(Self { nodes, from, to, heights_m })
    }

    /// Returns the nodes of the level above that surround those of this window.
    fn above(&self, ground: &GroundReader<'_>) -> Result<Option<Self>, QuantizedMeshError> {
        let Some(nodes) = self.nodes.above() else { return Ok(None) };
        let from = self.from.map(|index| index.div_euclid(2));
        let to = self.to.map(|index| (index + 1).div_euclid(2));
        let heights_m = ground.heights_at_nodes_m(nodes, around(from, to))?;
        Ok(Some(Self { nodes, from, to, heights_m }))
    }

    /// Returns the nodes, without those around, row by row from the south.
    fn inner(&self) -> impl Iterator<Item = [i64; 2]> + use<> {
        let ([west, south], [east, north]) = (self.from, self.to);
        (south..=north).flat_map(move |j| (west..=east).map(move |i| [i, j]))
    }

    fn at(&self, [i, j]: [i64; 2]) -> usize {
        let columns = self.to[0] - self.from[0] + 3;
        ((j - self.from[1] + 1) * columns + i - self.from[0] + 1) as usize
    }

    fn height_m(&self, node: [i64; 2]) -> f64 {
        self.heights_m[self.at(node)]
    }

    /// Fills in a height at each node without ground: the mean of its neighbours with ground, if
    /// any; otherwise the height at that place on the level above, which is filled in the same way;
    /// otherwise that of the ellipsoid.
    fn fill(&mut self, ground: &GroundReader<'_>) -> Result<(), QuantizedMeshError> {
        let gaps: Vec<[i64; 2]> =
            self.inner().filter(|node| self.height_m(*node).is_nan()).collect();
        if gaps.is_empty() {
            return Ok(());
        }
        let mut above = self.above(ground)?;
        if let Some(above) = &mut above {
            above.fill(ground)?;
        }
        let beside_ground = |[i, j]: [i64; 2]| {
            let around = (-1..=1).flat_map(|dj| (-1..=1).map(move |di| [i + di, j + dj]));
            mean(around.map(|node| self.height_m(node)).filter(|height_m| !height_m.is_nan()))
        };
        let between = |above: &Self, node: [i64; 2]| {
            let [low, high] = [0, 1].map(|up| node.map(|index| (index + up).div_euclid(2)));
            let around = [low, [high[0], low[1]], [low[0], high[1]], high];
            mean(around.into_iter().map(|node| above.height_m(node)))
        };
        let filled = gaps.into_iter().map(|node| {
            let height_m = beside_ground(node).or_else(|| between(above.as_ref()?, node));
            (self.at(node), height_m.unwrap_or(FAR_FROM_GROUND_M))
        });
        for (at, height_m) in filled.collect::<Vec<_>>() {
            self.heights_m[at] = height_m;
        }
        Ok(())
    }
}

/// Returns a rectangle of nodes with one more on each side.
fn around(from: [i64; 2], to: [i64; 2]) -> [[i64; 2]; 2] {
    [from.map(|index| index - 1), to.map(|index| index + 1)]
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), value| (sum + value, count + 1));
    (count > 0).then(|| sum / f64::from(count))
}

impl HeightRaster {
    /// Samples the ground. Where there is none, heights come from ever coarser nodes around, and
    /// finally from the ellipsoid. The rule depends on places over the whole globe, so neighbours
    /// have the same heights on their border.
    pub(crate) fn sample(
        nodes: RasterNodes,
        tile: TerrainTile,
        ground: &GroundReader<'_>,
    ) -> Result<Self, QuantizedMeshError> {
        let n = nodes.per_tile;
        let [i, j] = [i64::from(tile.x) * n, i64::from(tile.y) * n];
        let (from, to) = ([i - 1, j - 1], [i + n + 1, j + n + 1]);
        let mut window = Window::sample(nodes, from, to, ground)?;
        // Rows of the raster run southwards.
        let order: Vec<usize> = (from[1]..=to[1])
            .rev()
            .flat_map(|j| (from[0]..=to[0]).map(move |i| [i, j]))
            .map(|node| window.at(node))
            .collect();
        let is_ground = order.iter().map(|&at| !window.heights_m[at].is_nan()).collect();
        window.fill(ground)?;
        Ok(Self {
            nodes,
            tile,
            lon_deg: (from[0]..=to[0]).map(|i| nodes.lon_deg(i)).collect(),
            lat_deg: (from[1]..=to[1]).rev().map(|j| nodes.lat_deg(j)).collect(),
            heights_m: order.iter().map(|&at| window.heights_m[at]).collect(),
            is_ground,
        })
    }

    /// Nodes along each side of the tile, without those around it.
    pub(crate) fn side(&self) -> usize {
        self.nodes.per_tile as usize + 1
    }

    /// Returns the index in the raster of a node of the tile.
    pub(crate) fn at(&self, column: usize, row: usize) -> usize {
        (row + 1) * self.lon_deg.len() + column + 1
    }

    /// Longitude, latitude and height of a node of the raster.
    pub(crate) fn place(&self, at: usize) -> [f64; 3] {
        let columns = self.lon_deg.len();
        [self.lon_deg[at % columns], self.lat_deg[at / columns], self.heights_m[at]]
    }

    /// The extent of the tile in longitude and latitude.
    pub(crate) fn size_rad(&self) -> [f64; 2] {
        let [[west, south], [east, north]] = self.nodes.corners_deg(self.tile);
        [east - west, north - south].map(f64::to_radians)
    }

    /// Normal of the ground at a node, from its neighbours on all sides: the same in all tiles that
    /// have the node.
    pub(crate) fn normal(&self, at: usize) -> [f64; 3] {
        let columns = self.lon_deg.len();
        let of = |at: usize| geocentric_m(self.place(at));
        let way = |from: usize, to: usize| between(of(from), of(to));
        let across = cross(way(at - 1, at + 1), way(at + columns, at - columns));
        // At a pole, all longitudes are one place.
        if dot(across, across) > 0.0 { unit(across) } else { up_at(self.place(at)) }
    }

    fn normal_at(&self, steps: [u16; 2]) -> [f64; 3] {
        let at = self.cell_at(steps);
        let below = at + self.lon_deg.len();
        let is_node = steps.iter().all(|&step| {
            let cell = self.nodes.cell_of(step);
            self.nodes.step(cell) == step
        });
        if is_node { self.normal(below) } else { self.mean_normal(&[at, at + 1, below, below + 1]) }
    }

    pub(crate) fn mean_normal(&self, nodes: &[usize]) -> [f64; 3] {
        let normals: Vec<[f64; 3]> = nodes.iter().map(|&at| self.normal(at)).collect();
        unit([0, 1, 2].map(|axis| normals.iter().map(|normal| normal[axis]).sum()))
    }

    /// Returns the ground at the steps nearest to u and v: longitude, latitude and height. If there
    /// is none, returns it at the nearest of the steps around that have ground, so that the ground
    /// is covered up to its end. `None` if none has.
    pub(crate) fn at_steps(
        &self,
        uv: &[[f64; 2]],
        ground: &GroundReader<'_>,
    ) -> Result<Vec<Option<[f64; 3]>>, QuantizedMeshError> {
        let nearest: Vec<[u16; 2]> = uv.iter().map(|&uv| nearest_steps(uv)).collect();
        let mut found = self.ground_at(&nearest, ground)?;
        let gaps: Vec<usize> = (0..found.len()).filter(|&k| found[k].is_none()).collect();
        let around: Vec<[u16; 2]> = gaps.iter().flat_map(|&k| steps_around(uv[k])).collect();
        let beside = self.ground_at(&around, ground)?;
        for (k, places) in gaps.into_iter().zip(beside.chunks_exact(4)) {
            found[k] = places.iter().copied().flatten().next();
        }
        Ok(found)
    }

    fn ground_at(
        &self,
        steps: &[[u16; 2]],
        ground: &GroundReader<'_>,
    ) -> Result<Vec<Option<[f64; 3]>>, QuantizedMeshError> {
        let places: Vec<[f64; 2]> =
            steps.iter().map(|&steps| self.nodes.place_deg(self.tile, steps)).collect();
        let heights_m = ground.heights_m(&places)?;
        let whole = |([lon, lat], height_m): ([f64; 2], f64)| {
            (!height_m.is_nan()).then_some([lon, lat, height_m])
        };
        Ok(places.into_iter().zip(heights_m).map(whole).collect())
    }

    /// Returns a vertex at a place of [`Self::at_steps`]; `None` on a border, which only has the
    /// vertices that both tiles have.
    pub(crate) fn vertex(&self, place: [f64; 3]) -> Option<MeshVertex> {
        let [lon, lat, _] = place;
        let steps = nearest_steps(self.nodes.square_of(self.tile).uv_of([lon, lat]));
        let is_inside = steps.iter().all(|step| (1..LAST_STEP).contains(step));
        is_inside.then(|| MeshVertex::new(steps, place, self.normal_at(steps)))
    }

    /// Returns the ground of the tile at nodes and along borders. `level` is the package's level
    /// whose edges are used. Where the ground ends, this level may end earlier than the finest, so
    /// the ground is sampled more densely there.
    pub(crate) fn samples(
        &self,
        level: SourceLevel,
        ground: &GroundReader<'_>,
    ) -> Result<TileSamples, QuantizedMeshError> {
        let last = self.side() - 1;
        let nodes_of =
            |side: usize| (0..side).flat_map(move |row| (0..side).map(move |c| [c, row]));
        let step = |node: usize| self.nodes.step(node as i64);
        let mut inside = Vec::new();
        for [column, row] in nodes_of(last + 1) {
            let at = self.at(column, row);
            if self.is_ground[at] {
                let steps = [step(column), step(last - row)];
                inside.push(GroundSample::new(steps, self.place(at), [at; 2]));
            }
        }
        let mut wanted: Vec<([u16; 2], [usize; 2])> = Vec::new();
        if !level.is_finest {
            let at_outlines = nodes_of(last)
                .filter(|[column, row]| self.is_on_outline(*column, *row))
                .flat_map(|[column, row]| self.nodes.inside_cell([column, last - row - 1]));
            wanted.extend(at_outlines.map(|steps| (steps, [self.cell_at(steps); 2])));
        }
        let of_inside = wanted.len();
        let mut on_sides = Vec::new();
        for side in Side::ALL {
            let along = self.border_steps(side, level, ground)?;
            on_sides.push(along.len());
            wanted.extend(along.into_iter().map(|step| self.on_side(side, step)));
        }
        // All at once, so that tiles of the package are read once.
        let steps: Vec<[u16; 2]> = wanted.iter().map(|(steps, _)| *steps).collect();
        let places = self.ground_at(&steps, ground)?;
        let mut found = wanted.into_iter().zip(places).map(|((steps, between), place)| {
            place.map(|place| GroundSample::new(steps, place, between))
        });
        inside.extend(found.by_ref().take(of_inside).flatten());
        let border = |count| found.by_ref().take(count).flatten().collect();
        Ok(TileSamples { inside, borders: on_sides.into_iter().map(border).collect() })
    }

    /// Returns the steps at which the ground is sampled along a border, from the south or the west:
    /// at nodes, and where an edge of the package's level crosses the border, because the ground
    /// bends there. Below the finest level, also at parts of cells.
    fn border_steps(
        &self,
        side: Side,
        level: SourceLevel,
        ground: &GroundReader<'_>,
    ) -> Result<Vec<u16>, QuantizedMeshError> {
        let corners = self.nodes.corners_deg(self.tile);
        let ends = corners.map(|end| side.at(corners[side.far][side.across], end[1 - side.across]));
        let to_steps = |share: f64| {
            let step = share * f64::from(LAST_STEP);
            [step.floor() as u16, step.ceil() as u16]
        };
        let parts = if level.is_finest { 1 } else { self.nodes.parts };
        let mut steps = RasterNodes { parts, ..self.nodes }.border_steps();
        steps.extend(ground.crossings(ends, level.level)?.into_iter().flat_map(to_steps));
        steps.sort_unstable();
        steps.dedup();
        Ok(steps)
    }

    /// Whether the ground ends in the cell with this north-western node.
    fn is_on_outline(&self, column: usize, row: usize) -> bool {
        let corners = [[0, 0], [1, 0], [0, 1], [1, 1]];
        let grounds = corners.map(|[c, r]| self.is_ground[self.at(column + c, row + r)]);
        grounds.iter().any(|is_ground| *is_ground != grounds[0])
    }

    /// Returns a place on a border. Its normal is interpolated between the border's own nodes,
    /// which both tiles have.
    fn on_side(&self, side: Side, step: u16) -> ([u16; 2], [usize; 2]) {
        let last = self.side() - 1;
        let cell = self.nodes.cell_of(step) as usize;
        let nodes = [cell, cell + 1].map(|k| {
            let [column, from_south] = side.at(side.far * last, k);
            self.at(column, last - from_south)
        });
        (side.at(side.far as u16 * LAST_STEP, step), nodes)
    }

    /// Returns the north-western node of the cell that contains u and v.
    fn cell_at(&self, [u, v]: [u16; 2]) -> usize {
        let [column, from_south] = [u, v].map(|step| self.nodes.cell_of(step) as usize);
        self.at(column, self.side() - 2 - from_south)
    }
}

/// A side of a tile.
#[derive(Clone, Copy)]
struct Side {
    /// The axis across it: 0 from west to east, 1 from south to north.
    across: usize,
    /// 0 at the beginning of this axis, 1 at its end.
    far: usize,
}

impl Side {
    /// West, south, east and north.
    const ALL: [Self; 4] = [
        Self { across: 0, far: 0 },
        Self { across: 1, far: 0 },
        Self { across: 0, far: 1 },
        Self { across: 1, far: 1 },
    ];

    /// Returns a place, given by its coordinates across and along the side.
    fn at<T>(self, across: T, along: T) -> [T; 2] {
        if self.across == 0 { [across, along] } else { [along, across] }
    }
}

/// The package's level that is sampled.
#[derive(Clone, Copy)]
pub(crate) struct SourceLevel {
    pub(crate) level: u8,
    pub(crate) is_finest: bool,
}

/// Returns the steps nearest to u and v.
pub(crate) fn nearest_steps(uv: [f64; 2]) -> [u16; 2] {
    uv.map(|step| step.round().clamp(0.0, f64::from(LAST_STEP)) as u16)
}

/// Returns the steps around u and v, the nearest first.
fn steps_around([u, v]: [f64; 2]) -> [[u16; 2]; 4] {
    let [west, south] = [u.floor(), v.floor()];
    let mut found = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]
        .map(|[beside, above]| [west + beside, south + above]);
    let away = |at: &[f64; 2]| f64::hypot(at[0] - u, at[1] - v);
    found.sort_by(|one, other| away(one).total_cmp(&away(other)));
    found.map(nearest_steps)
}

/// The ground of a tile that its triangles must follow.
pub(crate) struct TileSamples {
    /// Samples anywhere in the tile.
    pub(crate) inside: Vec<GroundSample>,
    /// Samples along each border, from the south or the west: the same for both tiles that share
    /// it.
    pub(crate) borders: Vec<Vec<GroundSample>>,
}

impl TileSamples {
    pub(crate) fn is_empty(&self) -> bool {
        self.inside.is_empty() && self.borders.iter().all(Vec::is_empty)
    }
}

/// A place with ground.
#[derive(Clone, Copy)]
pub(crate) struct GroundSample {
    /// u and v.
    pub(crate) steps: [u16; 2],
    /// Longitude, latitude and height above the ellipsoid.
    pub(crate) place: [f64; 3],
    /// On a border, its nodes on both sides.
    pub(crate) between: [usize; 2],
    /// The position from the earth's centre.
    pub(crate) at_m: [f64; 3],
    /// The vertical.
    pub(crate) up: [f64; 3],
}

impl GroundSample {
    fn new(steps: [u16; 2], place: [f64; 3], between: [usize; 2]) -> Self {
        Self { steps, place, between, at_m: geocentric_m(place), up: up_at(place) }
    }
}
