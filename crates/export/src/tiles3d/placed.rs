//! A tile's triangles on the globe.

use std::collections::HashMap;

use corniche_geom::TileId;

use crate::{
    error::CoordinatesError,
    globe::{RootFrame, between, cross, dot, middle_of, unit},
    places::Places,
    plane::sides,
    relief_map::tangent,
    surfaces::{LabelledMesh, across},
};

/// The finest grid of positions: 2⁻¹⁰ m.
const FINEST_STEP_LOG2: i32 = -10;
/// The bits of whole numbers that an f32 represents exactly.
const F32_WHOLE_LOG2: i32 = 24;

/// Returns the step of a level's positions, metres: a tile's middle plus an offset in f32 is then
/// exact. It is the largest power of two for tiles whose corners are at most `reach_m` from their
/// middle.
pub(crate) fn step_m(reach_m: f64) -> f64 {
    let needed = reach_m.log2().ceil() as i32 - F32_WHOLE_LOG2;
    2.0_f64.powi(needed.max(FINEST_STEP_LOG2))
}

/// A vertex on the globe.
#[derive(Clone, Copy)]
pub(crate) struct PlacedVertex {
    /// The position relative to the tile's middle, along the root frame's axes, metres.
    pub(crate) at_m: [f32; 3],
    pub(crate) normal: [f32; 3],
    /// The tangent of the relief's normal map.
    pub(crate) tangent: [f32; 3],
    /// Height in the package's datum, which determines the colour.
    pub(crate) height_m: f64,
    /// Shares of the way across the tile, from the west and from the north.
    pub(crate) across: [f32; 2],
    /// The sides of the tile on which the vertex is: west, east, south, north.
    sides: [bool; 4],
}

/// A tile on the globe.
pub(crate) struct PlacedTile {
    /// The middle in the root frame; whole steps.
    pub(crate) middle_m: [f64; 3],
    pub(crate) vertices: Vec<PlacedVertex>,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) labels: Vec<u32>,
    /// Grid east, grid north and up in the middle of the tile, in the root frame: perpendicular
    /// unit vectors.
    pub(crate) axes: [[f64; 3]; 3],
}

/// Longitude and latitude of a place, and its position in the root frame.
type OnGlobe = ([f64; 2], [f64; 3]);

/// Places tiles on the globe.
pub(crate) struct TilePlacement<'a> {
    pub(crate) places: &'a Places<'a>,
    pub(crate) root: &'a RootFrame,
    /// The step of the level's positions.
    pub(crate) step_m: f64,
}

impl TilePlacement<'_> {
    /// Transforms a tile's triangles to the globe, each vertex separately. Vertices that fall on
    /// one place are merged (those of slabs only if they share a normal), and triangles without
    /// area are dropped.
    pub(crate) fn place(
        &self,
        id: TileId,
        mesh: &LabelledMesh,
    ) -> Result<PlacedTile, CoordinatesError> {
        let frame = &self.places.manifest.frame;
        let bounds = frame.tile_lattice_bounds(id);
        let places = mesh.vertices.iter().map(|vertex| (mesh.on_lattice(vertex), vertex.height_m));
        let placed = self.on_globe(places)?;
        let axes = self.axes(mesh)?;
        let middle_m = middle_of(&placed.iter().map(|(_, at)| *at)).map(|axis| self.snap(axis));
        let mut tile = PlacedTile {
            middle_m,
            vertices: Vec::with_capacity(placed.len()),
            triangles: Vec::with_capacity(mesh.triangles.len()),
            labels: Vec::with_capacity(mesh.labels.len()),
            axes,
        };
        let mut known: HashMap<([u32; 3], Option<[u32; 3]>), u32> =
            HashMap::with_capacity(placed.len());
        let mut number = Vec::with_capacity(placed.len());
        for (vertex, (place_deg, at)) in mesh.vertices.iter().zip(placed) {
            let at_m = between(middle_m, at).map(|axis| axis as f32);
            let next = tile.vertices.len() as u32;
            // Adding 0 makes both zeros equal.
            let bits = |vector: [f32; 3]| vector.map(|axis| (axis + 0.0).to_bits());
            let own_normal = vertex.on_slab.then(|| bits(vertex.normal));
            let place = *known.entry((bits(at_m), own_normal)).or_insert(next);
            number.push(place);
            // Slabs have no skirts.
            let on_sides = sides(mesh.on_lattice(vertex), &bounds);
            let sides = on_sides.map(|on_side| on_side && !vertex.on_slab);
            if place == next {
                let grid = grid_axes(axes[1], self.root.up_at(place_deg));
                let [normal, tangent] =
                    [vertex.normal, tangent(vertex.normal)].map(|along| turned(along, grid));
                let height_m = vertex.height_m;
                let across = across(mesh.on_lattice(vertex), &bounds);
                tile.vertices.push(PlacedVertex { at_m, normal, tangent, height_m, across, sides });
            } else {
                let own = &mut tile.vertices[place as usize].sides;
                *own = [0, 1, 2, 3].map(|side| own[side] || sides[side]);
            }
        }
        for (triangle, label) in mesh.triangles.iter().zip(&mesh.labels) {
            let [a, b, c] = triangle.map(|corner| number[corner as usize]);
            if a != b && b != c && c != a {
                tile.triangles.push([a, b, c]);
                tile.labels.push(*label);
            }
        }
        Ok(tile)
    }

    /// Transforms places on the lattice with heights, relative to the middle of a tile.
    pub(crate) fn positions(
        &self,
        places: impl Iterator<Item = ([f64; 2], f64)>,
        middle_m: [f64; 3],
    ) -> Result<Vec<[f32; 3]>, CoordinatesError> {
        let placed = self.on_globe(places)?.into_iter();
        Ok(placed.map(|(_, at)| between(middle_m, at).map(|axis| axis as f32)).collect())
    }

    /// Transforms places on the lattice with heights to the globe.
    fn on_globe(
        &self,
        places: impl Iterator<Item = ([f64; 2], f64)>,
    ) -> Result<Vec<OnGlobe>, CoordinatesError> {
        let frame = &self.places.manifest.frame;
        let (mut plan, mut heights_m): (Vec<[f64; 2]>, Vec<f64>) =
            places.map(|(at, height_m)| (frame.position_of_fraction_m(at), height_m)).unzip();
        self.places.to_wgs84(&mut plan, &mut heights_m)?;
        let placed = plan.into_iter().zip(heights_m).map(|([lon, lat], height_m)| {
            (
                [lon, lat],
                self.root.position_in_root([lon, lat, height_m]).map(|axis| self.snap(axis)),
            )
        });
        Ok(placed.collect())
    }

    fn snap(&self, metres: f64) -> f64 {
        (metres / self.step_m).round() * self.step_m
    }

    /// Returns grid east, grid north and up in the middle of a tile, computed from two places next
    /// to it.
    fn axes(&self, mesh: &LabelledMesh) -> Result<[[f64; 3]; 3], CoordinatesError> {
        let frame = &self.places.manifest.frame;
        let [x, y] = frame.position_m(mesh.middle);
        let beside = frame.cell().north_m;
        let mut plan = [[x, y - beside], [x, y + beside], [x, y]];
        self.places.to_wgs84_plan(&mut plan)?;
        let [south, north, middle] = plan;
        let at = |[lon, lat]: [f64; 2]| self.root.position_in_root([lon, lat, 0.0]);
        Ok(grid_axes(between(at(south), at(north)), self.root.up_at(middle)))
    }
}

/// Returns east, north and up of the grid at a place with this upward direction.
fn grid_axes(grid_north: [f64; 3], up: [f64; 3]) -> [[f64; 3]; 3] {
    let east = unit(cross(grid_north, up));
    [east, cross(up, east), up]
}

/// Returns a direction of the package, given along these axes, in the root frame.
fn turned(along: [f32; 3], [east, north, up]: [[f64; 3]; 3]) -> [f32; 3] {
    let [x, y, z] = along.map(f64::from);
    let turned = [0, 1, 2].map(|axis| x * east[axis] + y * north[axis] + z * up[axis]);
    unit(turned).map(|axis| axis as f32)
}

/// A box along given axes.
#[derive(Clone, Copy)]
pub(crate) struct TileBox {
    axes: [[f64; 3]; 3],
    low: [f64; 3],
    high: [f64; 3],
}

impl TileBox {
    /// An empty box.
    pub(crate) fn along(axes: [[f64; 3]; 3]) -> Self {
        Self { axes, low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] }
    }

    pub(crate) fn include(&mut self, at_m: [f64; 3]) {
        for (axis, along) in self.axes.iter().enumerate() {
            let place = dot(*along, at_m);
            self.low[axis] = self.low[axis].min(place);
            self.high[axis] = self.high[axis].max(place);
        }
    }

    pub(crate) fn include_box(&mut self, other: &Self) {
        for corner in 0..8_usize {
            let along = [0, 1, 2].map(|axis: usize| {
                if corner >> axis & 1 == 0 { other.low[axis] } else { other.high[axis] }
            });
            self.include(
                [0, 1, 2].map(|k: usize| {
                    (0..3).map(|axis| along[axis] * other.axes[axis][k]).sum::<f64>()
                }),
            );
        }
    }

    fn sides_m(&self) -> [f64; 3] {
        between(self.low, self.high)
    }

    /// Its longest side.
    pub(crate) fn longest_side_m(&self) -> f64 {
        self.sides_m().into_iter().fold(0.0, f64::max)
    }

    /// The length of its diagonal.
    pub(crate) fn diagonal_m(&self) -> f64 {
        let sides_m = self.sides_m();
        dot(sides_m, sides_m).sqrt()
    }

    /// Returns the box in the form of 3D Tiles: the middle and three half axes. It is slightly
    /// enlarged, so that rounding excludes nothing.
    pub(crate) fn numbers(&self) -> Vec<f64> {
        const MARGIN_M: f64 = 0.01;
        let middle: [f64; 3] = [0, 1, 2].map(|k: usize| {
            (0..3)
                .map(|axis| self.axes[axis][k] * f64::midpoint(self.low[axis], self.high[axis]))
                .sum()
        });
        let half = (0..3).flat_map(|axis| {
            let length = (self.high[axis] - self.low[axis]) / 2.0 + MARGIN_M;
            self.axes[axis].map(move |part| part * length)
        });
        // The margin is larger than a tenth of a millimetre.
        middle.into_iter().chain(half).map(|number| (number * 1e4).round() / 1e4).collect()
    }
}

/// The skirts of a tile.
#[derive(Default)]
pub(crate) struct Skirt {
    /// Positions relative to the tile's middle, with the tile's vertex whose normal and colour they
    /// share.
    pub(crate) vertices: Vec<([f32; 3], u32)>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Skirt {
    /// Returns skirts of this depth below each edge along a side of the tile.
    pub(crate) fn below(tile: &PlacedTile, depth_m: f64) -> Self {
        let mut skirt = Self::default();
        let mut place = vec![u32::MAX; tile.vertices.len()];
        let [.., up] = tile.axes;
        for triangle in &tile.triangles {
            for k in 0..3 {
                let ends = [triangle[k], triangle[(k + 1) % 3]];
                let [one, other] = ends.map(|vertex| tile.vertices[vertex as usize].sides);
                if !(0..4).any(|side| one[side] && other[side]) {
                    continue;
                }
                // An edge along a side that two triangles share results from merged vertices.
                let [a, b] = ends.map(|vertex| {
                    let place = &mut place[vertex as usize];
                    if *place == u32::MAX {
                        *place = skirt.vertices.len() as u32;
                        let top = tile.vertices[vertex as usize].at_m;
                        let bottom: [f32; 3] = [0, 1, 2]
                            .map(|axis| (f64::from(top[axis]) - depth_m * up[axis]) as f32);
                        skirt.vertices.extend([(top, vertex), (bottom, vertex)]);
                    }
                    *place
                });
                // Counter-clockwise from outside.
                skirt.triangles.extend([[b, a, a + 1], [b, a + 1, b + 1]]);
            }
        }
        skirt
    }
}

#[cfg(test)]
#[path = "placed_tests.rs"]
mod tests;
