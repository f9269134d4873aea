//! Heights of a package's finest ground at places on the globe.

use std::{collections::BTreeMap, sync::Arc};

use corniche_geom::{Bounds, LatticeBounds, LatticePoint, Seam, TileId};
use corniche_tileset::{FilePackage, Manifest, Sections};
use corniche_tin::{NO_TWIN, Surface};
use corniche_work::Recent;

use super::tiling::RasterNodes;
use crate::{error::QuantizedMeshError, places::Places, plane};

/// The margin around a line in which triangle edges that may cross it are searched, as a share of
/// its length: meridians and parallels bend in the package's CRS.
const ROOM_BESIDE_LINES: f64 = 0.01;

/// Reads the ground tile by tile. Each thread has a reader, and all readers share a cache.
pub(crate) struct GroundReader<'a> {
    package: &'a FilePackage,
    kept: &'a SharedGroundCache,
    places: Places<'a>,
    /// The rectangle of degrees outside of which there is no ground.
    around_deg: Bounds,
}

impl<'a> GroundReader<'a> {
    pub(crate) fn new(
        package: &'a FilePackage,
        kept: &'a SharedGroundCache,
        places: Places<'a>,
    ) -> Self {
        let data = package.manifest().wgs84_bounds;
        // Sides of the data may bend a little beyond the sampled positions.
        let margin = 0.001 + 0.02 * (data.max_x - data.min_x).max(data.max_y - data.min_y);
        let around_deg = data.expanded([margin; 2]);
        Self { package, kept, places, around_deg }
    }

    /// Returns the requested heights at longitudes and latitudes; NaN where there is no ground. The
    /// result for a place depends on nothing but the place.
    pub(crate) fn heights_m(
        &self,
        places_deg: &[[f64; 2]],
    ) -> Result<Vec<f64>, QuantizedMeshError> {
        let near: Vec<usize> =
            (0..places_deg.len()).filter(|&k| self.is_near(places_deg[k])).collect();
        let mut positions: Vec<[f64; 2]> = near.iter().map(|&k| places_deg[k]).collect();
        self.places.working_from_wgs84(&mut positions)?;
        let mut own = vec![f64::NAN; positions.len()];
        for side in [[0, 0], [-1, 0], [0, 1], [-1, 1]] {
            self.add_heights(&positions, side, &mut own)?;
        }
        let on_ground = near.into_iter().zip(positions.into_iter().zip(own));
        let on_ground = on_ground.filter(|(_, (_, height_m))| !height_m.is_nan());
        let (found, (at, mut wanted)): (Vec<usize>, (Vec<_>, Vec<_>)) = on_ground.unzip();
        self.places.to_wanted_heights(&at, &mut wanted)?;
        let at_deg: Vec<[f64; 2]> = found.iter().map(|&k| places_deg[k]).collect();
        self.places.all_have_heights(&at_deg, &wanted)?;
        let mut heights_m = vec![f64::NAN; places_deg.len()];
        for (k, height_m) in found.into_iter().zip(wanted) {
            heights_m[k] = height_m;
        }
        Ok(heights_m)
    }

    /// Returns the same at the nodes of a rectangle, given by its south-western and north-eastern
    /// node, row by row from the south; for few nodes that many tiles use.
    pub(crate) fn heights_at_nodes_m(
        &self,
        nodes: RasterNodes,
        [from, to]: [[i64; 2]; 2],
    ) -> Result<Vec<f64>, QuantizedMeshError> {
        self.kept.node_heights.of_nodes(nodes, from, to, |places_deg| self.heights_m(places_deg))
    }

    fn is_near(&self, [lon, lat]: [f64; 2]) -> bool {
        let seam = Seam::of_degrees().around(self.around_deg.center()[0]);
        self.around_deg.contains([seam.image(lon), lat])
    }

    /// Returns the vertices and triangle edges of one of the package's levels around a rectangle of
    /// degrees, given by its south-western and north-eastern corner. `point_of` makes points of
    /// longitude, latitude and height. The distance between the ground and a surface of other
    /// triangles is largest at a vertex of either, or at a crossing of edges.
    pub(crate) fn bends<T>(
        &self,
        corners_deg: [[f64; 2]; 2],
        level: u8,
        point_of: impl Fn([f64; 3]) -> T,
    ) -> Result<Bends<T>, QuantizedMeshError> {
        const NEW: u32 = u32::MAX;
        let mut bends = Bends { points: Vec::new(), edges: Vec::new() };
        for part in self.near_parts(corners_deg) {
            self.for_each_tile(part, level, |tile, edges| {
                let mut number = vec![NEW; tile.places.len()];
                bends.edges.reserve_exact(edges.len());
                bends.points.reserve_exact(edges.len().min(tile.places.len()));
                for edge in edges {
                    let ends = edge.map(|vertex| vertex as usize);
                    if ends.iter().any(|&vertex| tile.places[vertex][2].is_nan()) {
                        continue;
                    }
                    bends.edges.push(ends.map(|vertex| {
                        if number[vertex] == NEW {
                            number[vertex] = bends.points.len() as u32;
                            bends.points.push(point_of(tile.places[vertex]));
                        }
                        number[vertex]
                    }));
                }
            })?;
        }
        Ok(bends)
    }

    /// Returns the crossings of a level's triangle edges with a meridian or a parallel, given by
    /// its ends, as shares of the way from its first end. The result depends on the line alone, so
    /// tiles on both of its sides get the same.
    pub(crate) fn crossings(
        &self,
        [from_deg, to_deg]: [[f64; 2]; 2],
        level: u8,
    ) -> Result<Vec<f64>, QuantizedMeshError> {
        // The axis along which the line runs, and the one along which it is constant.
        let long = [0, 1].map(|axis| (to_deg[axis] - from_deg[axis]).abs());
        let along = usize::from(long[1] > long[0]);
        let across = 1 - along;
        let length_deg = to_deg[along] - from_deg[along];
        let room_deg = length_deg * ROOM_BESIDE_LINES;
        let corners_deg = [from_deg.map(|at| at - room_deg), to_deg.map(|at| at + room_deg)];
        let mut shares = Vec::new();
        for part in self.near_parts(corners_deg) {
            // Where the data cross 180°, the line has their longitudes.
            let seam = Seam::of_degrees().around(part.center()[0]);
            let from_deg = [seam.image(from_deg[0]), from_deg[1]];
            let (line, begin) = (from_deg[across], from_deg[along]);
            self.for_each_tile(part, level, |tile, edges| {
                let points = tile.surface.points();
                for ends in edges {
                    let ends = ends.map(|vertex| vertex as usize);
                    let [first, last] = ends.map(|vertex| tile.places[vertex][across] - line);
                    if (first - last).abs() < f64::MIN_POSITIVE || first * last > 0.0 {
                        continue;
                    }
                    let [from, to] = ends.map(|vertex| points[vertex].in_steps());
                    let place = |share: f64| self.places.wgs84(plane::along(from, to, share));
                    let guess = first / (first - last);
                    let off = place(guess)[across] - line;
                    let better = guess - off / (last - first);
                    let share = (place(better.clamp(0.0, 1.0))[along] - begin) / length_deg;
                    shares.extend(Some(share).filter(|share| (0.0..=1.0).contains(share)));
                }
            })?;
        }
        Ok(shares)
    }

    /// Calls `each` for the tiles of one of the package's levels near a rectangle with the
    /// longitudes of the data, with those of their edges that come near it.
    fn for_each_tile(
        &self,
        area_deg: Bounds,
        level: u8,
        mut each: impl FnMut(&SurfaceTile, Vec<[u32; 2]>),
    ) -> Result<(), QuantizedMeshError> {
        let manifest = self.package.manifest();
        let frame = &manifest.frame;
        let mut around = perimeter(area_deg);
        self.places.working_from_wgs84(&mut around)?;
        let known = around.iter().filter(|place| place.iter().all(|x| x.is_finite()));
        let bounds_m = Bounds::around(known);
        let bounds_m = bounds_m.expanded([0.02 * bounds_m.width().max(bounds_m.height()); 2]);
        let corners = [[bounds_m.min_x, bounds_m.max_y], [bounds_m.max_x, bounds_m.min_y]];
        let [Some(first), Some(last)] = corners.map(|corner| frame.snap(corner)) else {
            return Ok(());
        };
        let bounds = LatticeBounds {
            min: LatticePoint::new(first.u, last.v),
            max: LatticePoint::new(last.u, first.v),
        };
        let most = (1_i64 << level) - 1;
        let [from, to] = [first, last]
            .map(|corner| frame.tile_column_row(level, corner).map(|k| k.clamp(0, most)));
        for (column, row) in
            (from[1]..=to[1]).flat_map(|row| (from[0]..=to[0]).map(move |c| (c, row)))
        {
            let Ok(id) = TileId::new(level, column as u32, row as u32) else { continue };
            if let Some(tile) = &*self.tile(id)? {
                each(tile, tile.edges_near(bounds));
            }
        }
        Ok(())
    }

    /// Returns the parts of a rectangle of degrees that may have ground, with the longitudes of the
    /// data: several if the data cross 180° and the rectangle goes around the globe.
    fn near_parts(&self, [[west, south], [east, north]]: [[f64; 2]; 2]) -> Vec<Bounds> {
        let part = |turns: f64| {
            let [min_x, max_x] = [west, east].map(|lon| lon + 360.0 * turns);
            Bounds { min_x, min_y: south, max_x, max_y: north }.intersection(&self.around_deg)
        };
        let parts = [-1.0, 0.0, 1.0].map(part);
        parts
            .into_iter()
            .filter(|part| part.min_x < part.max_x && part.min_y < part.max_y)
            .collect()
    }

    /// Adds heights, in the package's datum, at positions that have none yet: from the tile that
    /// contains the point one step aside. On a border these are all tiles around it, of which one
    /// may have ground where another has none.
    fn add_heights(
        &self,
        positions: &[[f64; 2]],
        side: [i64; 2],
        heights_m: &mut [f64],
    ) -> Result<(), QuantizedMeshError> {
        let frame = &self.package.manifest().frame;
        let finest = frame.max_level();
        let tile_beside = |point: LatticePoint, [du, dv]: [i64; 2]| {
            let beside = LatticePoint::new(point.u + du, point.v + dv);
            let [column, row] = frame.tile_column_row(finest, beside);
            TileId::new(finest, u32::try_from(column).ok()?, u32::try_from(row).ok()?).ok()
        };
        let mut by_tile: BTreeMap<TileId, Vec<(usize, LatticePoint)>> = BTreeMap::new();
        for (k, position) in positions.iter().enumerate().filter(|(k, _)| heights_m[*k].is_nan()) {
            let Some(point) = frame.snap(*position) else { continue };
            let tile = tile_beside(point, side);
            let is_new = side == [0, 0] || tile != tile_beside(point, [0, 0]);
            if let Some(id) = tile.filter(|_| is_new) {
                by_tile.entry(id).or_default().push((k, point));
            }
        }
        for (id, members) in by_tile {
            let tile = self.tile(id)?;
            let Some(tile) = &*tile else { continue };
            for (k, point) in members {
                if let Some(triangle) = tile.surface.locate(point) {
                    let at = frame.fraction_of_position(positions[k]);
                    heights_m[k] = tile.surface.height_in_triangle_m(triangle, at);
                }
            }
        }
        Ok(())
    }

    fn tile(&self, id: TileId) -> Result<Arc<Option<SurfaceTile>>, QuantizedMeshError> {
        let bytes = |tile: &Option<SurfaceTile>| tile.as_ref().map_or(0, SurfaceTile::bytes);
        self.kept.surfaces.get(id, || self.read(id), bytes)
    }

    fn read(&self, id: TileId) -> Result<Option<SurfaceTile>, QuantizedMeshError> {
        let manifest = self.package.manifest();
        let Manifest { frame, coordinates, .. } = manifest;
        let payload = self.package.payload(id, Sections::TERRAIN)?;
        let Some(terrain) = payload.and_then(|payload| payload.terrain) else { return Ok(None) };
        let surface = manifest.surface(id, &terrain.tin);
        let points = surface.points().iter().map(|point| point.in_steps());
        let positions: Vec<[f64; 2]> =
            points.map(|steps| frame.position_of_fraction_m(steps)).collect();
        let plan: Vec<[f64; 2]> =
            positions.iter().map(|&at| coordinates.wgs84_from_working(at)).collect();
        let heights_m = if id.z() == frame.max_level() {
            let mut heights_m = surface.heights_m().to_vec();
            self.places.to_wanted_heights(&positions, &mut heights_m)?;
            heights_m
        } else {
            self.heights_m(&plan)?
        };
        let place = |([lon, lat], height_m): ([f64; 2], f64)| {
            // Where no height can be computed, the vertex has no height.
            [lon, lat, if height_m.is_finite() { height_m } else { f64::NAN }]
        };
        let places = plan.into_iter().zip(heights_m).map(place).collect();
        Ok(Some(SurfaceTile { surface, places }))
    }
}

/// The vertices and triangle edges at which the ground bends.
pub(crate) struct Bends<T> {
    /// Vertices.
    pub(crate) points: Vec<T>,
    /// Edges between them.
    pub(crate) edges: Vec<[u32; 2]>,
}

/// Returns places along the sides of a rectangle.
fn perimeter(bounds: Bounds) -> Vec<[f64; 2]> {
    const PARTS: u32 = 16;
    let share = |k: u32| f64::from(k) / f64::from(PARTS);
    let x = |k: u32| bounds.min_x + bounds.width() * share(k);
    let y = |k: u32| bounds.min_y + bounds.height() * share(k);
    let sides = (0..=PARTS).map(|k| {
        [[x(k), bounds.min_y], [x(k), bounds.max_y], [bounds.min_x, y(k)], [bounds.max_x, y(k)]]
    });
    sides.flatten().collect()
}

/// The approximate size of the cache of the package's tiles: a square degree of SRTM at its default
/// bound, which the coarse levels use again and again. With a smaller cache, tiles are decoded so
/// often that exports take longer, without needing less memory overall.
const KEPT_BYTES: u64 = 112 << 20;
/// The approximate memory of a triangle with its half of a vertex: corners and twins take 24 bytes,
/// lists by vertex and by square some 30, the vertex some 24.
const TRIANGLE_BYTES: u64 = 96;

/// The cache of tiles that all threads share.
pub(crate) struct SharedGroundCache {
    /// The tiles; `None` for tiles without ground.
    surfaces: Recent<TileId, Option<SurfaceTile>>,
    node_heights: NodeHeights,
}

impl SharedGroundCache {
    /// Returns an empty cache.
    pub(crate) fn new() -> Self {
        Self { surfaces: Recent::new(KEPT_BYTES), node_heights: NodeHeights::new() }
    }
}

/// The ground of a tile of the package.
struct SurfaceTile {
    surface: Surface,
    /// Longitude, latitude and requested height of each vertex; the height is NaN where the finest
    /// level has no ground.
    places: Vec<[f64; 3]>,
}

impl SurfaceTile {
    /// The approximate memory of the tile.
    fn bytes(&self) -> u64 {
        self.surface.triangles().len() as u64 * TRIANGLE_BYTES
    }

    /// Returns the edges of all triangles that come near a box, each once.
    fn edges_near(&self, bounds: LatticeBounds) -> Vec<[u32; 2]> {
        let mut is_near = vec![false; self.surface.triangles().len()];
        let mut near = Vec::new();
        self.surface.visit_triangles_near(bounds, |triangle| {
            if !std::mem::replace(&mut is_near[triangle as usize], true) {
                near.push(triangle);
            }
        });
        let sides = near.into_iter().flat_map(|triangle| (0..3).map(move |k| 3 * triangle + k));
        let is_first = |half_edge: &u32| {
            let twin = self.surface.twin(*half_edge);
            twin == NO_TWIN || *half_edge < twin || !is_near[twin as usize / 3]
        };
        sides.filter(is_first).map(|half_edge| self.surface.ends(half_edge)).collect()
    }
}

/// Nodes along each side of a block. A block is sampled as a whole.
const BLOCK: i64 = 16;
/// The approximate size of the cache of blocks: the many tiles along the end of the ground use the
/// same few of them.
const KEPT_NODE_BYTES: u64 = 4 << 20;

/// The key of a block of nodes: their level, the number of them along a tile, and the block's
/// column and row.
type Key = (u8, i64, [i64; 2]);

/// A cache of heights at nodes. Without it, each tile would read tiles of the package all over its
/// area, for a few places in each.
struct NodeHeights(Recent<Key, Vec<f64>>);

impl NodeHeights {
    pub(crate) fn new() -> Self {
        Self(Recent::new(KEPT_NODE_BYTES))
    }

    /// Returns heights at the nodes of a rectangle, given by its south-western and north-eastern
    /// node, row by row from the south. `sample` returns heights at longitudes and latitudes,
    /// always the same for a place.
    ///
    /// # Errors
    /// Returns the errors of `sample`.
    fn of_nodes(
        &self,
        nodes: RasterNodes,
        [west, south]: [i64; 2],
        [east, north]: [i64; 2],
        sample: impl Fn(&[[f64; 2]]) -> Result<Vec<f64>, QuantizedMeshError>,
    ) -> Result<Vec<f64>, QuantizedMeshError> {
        let columns = (east - west + 1) as usize;
        let mut heights_m = vec![f64::NAN; columns * (north - south + 1) as usize];
        let blocks = |first: i64, last: i64| first.div_euclid(BLOCK)..=last.div_euclid(BLOCK);
        for block_row in blocks(south, north) {
            for block_column in blocks(west, east) {
                let corner = [block_column * BLOCK, block_row * BLOCK];
                let key = (nodes.level, nodes.per_tile, [block_column, block_row]);
                let end = corner.map(|index| index + BLOCK - 1);
                let make = || sample(&nodes.places_deg(corner, end));
                let block = self.0.get(key, make, |block| size_of_val(&block[..]) as u64)?;
                let [i0, j0] = corner;
                for j in south.max(j0)..=north.min(j0 + BLOCK - 1) {
                    let [first, last] = [west.max(i0), east.min(i0 + BLOCK - 1)];
                    let (from, count) =
                        ((j - j0) * BLOCK + first - i0, (last - first + 1) as usize);
                    let into = (j - south) as usize * columns + (first - west) as usize;
                    heights_m[into..into + count]
                        .copy_from_slice(&block[from as usize..from as usize + count]);
                }
            }
        }
        Ok(heights_m)
    }
}

#[cfg(test)]
#[path = "ground_tests.rs"]
mod tests;
