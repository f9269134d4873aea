//! Triangulates a tile's raster.

use corniche_geom::{HeightGrid, wgs84::SEMI_MAJOR_M};
use corniche_tin::{Tin, TinSpec, TriangulateError, height_quantum_m, triangulate};
use spade::{
    DelaunayTriangulation, InsertionError, Triangulation as _, handles::FixedVertexHandle,
};

use super::{
    facets::{Facets, MeshVertex},
    raster::{GroundSample, HeightRaster},
    tiling::LAST_STEP,
};
use crate::globe::{between, dot, geocentric_m, range_of};

/// The share of a level's error that the TIN may have at nodes. The rest is reserved for the
/// globe's curvature, which the plane of the TIN only approximates.
const SHARE_OF_TIN: f64 = 0.7;
/// The share above which a place becomes a vertex. The rest is reserved for the detail of the
/// ground beyond the sampled level ([`SHARE_OF_SAMPLES`]), and for the rounding of places and
/// heights.
pub(crate) const SHARE_OF_VERTICES: f64 = 0.8;
/// The share that the sampled level of the package may be off.
pub(crate) const SHARE_OF_SAMPLES: f64 = 0.1;

/// A tile in the form in which it is written.
pub(crate) struct QuantizedTile {
    pub(crate) vertices: Vec<MeshVertex>,
    /// Counter-clockwise from above.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Heights of the lowest and the highest vertex, in the precision of the file.
    pub(crate) range_m: [f32; 2],
}

/// The distances between the ground and the triangles, which are flat as drawn on the globe.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct MeshDeviation {
    /// The number of places with ground that were measured.
    pub(crate) places: u64,
    pub(crate) largest_m: f64,
    /// Sum of squares.
    pub(crate) squares_m2: f64,
}

impl MeshDeviation {
    pub(crate) fn note(&mut self, off_m: f64) {
        self.add(&Self { places: 1, largest_m: off_m, squares_m2: off_m * off_m });
    }

    pub(crate) fn add(&mut self, other: &Self) {
        self.places += other.places;
        self.largest_m = self.largest_m.max(other.largest_m);
        self.squares_m2 += other.squares_m2;
    }
}

/// Returns the vertices of a TIN over the nodes of a raster, within a share of a level's error. The
/// error counts from the flat triangles that are drawn on the globe.
///
/// Edges are chords of the globe. `triangulate` works in a plane, so the bulge of the globe over
/// the tile's own frame is added to heights: terrain that is flat on the globe is then nearly flat,
/// too, and terrain that bulges is divided. The bulge is 0 in the corners, and on a border it
/// depends on the border alone:
///
/// ```text
///        ___---___          R/2 · (Δlat² · v (1 − v) + cos² lat · Δlon² · u (1 − u)),  u and v from 0 to 1
///      /           \
///     ●─────────────●
/// ```
pub(crate) fn tin_of(raster: &HeightRaster, error_m: f64) -> Result<Tin, TriangulateError> {
    let side = raster.side();
    let nodes = raster.nodes;
    let [width, height] = raster.size_rad();
    let bent = |share: f64| share * (1.0 - share);
    let grid = HeightGrid::from_fn(side + 2, side + 2, |column, row| {
        let at = row * (side + 2) + column;
        // Nodes around the tile only indicate that there is ground.
        let across = (column.clamp(1, side) - 1) as i64;
        let along = (side - row.clamp(1, side)) as i64;
        let cos = raster.lat_deg[row].to_radians().cos();
        let bulge = height * height * bent(nodes.share(along))
            + cos * cos * width * width * bent(nodes.share(across));
        (raster.heights_m[at] + SEMI_MAJOR_M / 2.0 * bulge) as f32
    });
    let max_error_m = error_m * SHARE_OF_TIN;
    triangulate(&grid, TinSpec { max_error_m, quantum_m: height_quantum_m(max_error_m) })
}

/// A tile while it is meshed.
pub(crate) struct Mesh {
    triangles: DelaunayTriangulation<MeshVertex>,
    range_m: [f32; 2],
}

impl Mesh {
    pub(crate) fn new(raster: &HeightRaster, tin: &Tin) -> Result<Self, InsertionError> {
        let side = raster.side();
        let vertices = tin.vertices().iter().map(|vertex| {
            let [column, row] = [vertex.column, vertex.row].map(usize::from);
            let at = raster.at(column, row);
            let steps = [column, side - 1 - row].map(|node| raster.nodes.step(node as i64));
            MeshVertex::new(steps, raster.place(at), raster.normal(at))
        });
        let triangles = DelaunayTriangulation::bulk_load(vertices.collect())?;
        Ok(Self { triangles, range_m: [0.0; 2] })
    }

    /// Turns those places of a border into vertices that are too far from the chords between its
    /// vertices, the farthest first. The result depends on the border alone, so both tiles that
    /// share it have the same.
    pub(crate) fn refine_border(
        &mut self,
        raster: &HeightRaster,
        samples: &[GroundSample],
        error_m: f64,
    ) -> Result<(), InsertionError> {
        let limit_m = error_m * SHARE_OF_VERTICES;
        let Some((first, last)) = samples.first().zip(samples.last()) else { return Ok(()) };
        let axis = usize::from(first.steps[0] == last.steps[0]);
        let other = 1 - axis;
        let mut on_border: Vec<MeshVertex> = self
            .triangles
            .vertices()
            .map(|vertex| *vertex.data())
            .filter(|vertex| vertex.steps[other] == first.steps[other])
            .collect();
        on_border.sort_unstable_by_key(|vertex| vertex.steps[axis]);
        let mut chords: Vec<[MeshVertex; 2]> =
            on_border.windows(2).map(|pair| [pair[0], pair[1]]).collect();
        while let Some([from, to]) = chords.pop() {
            let [low, high] = [from, to].map(|vertex| vertex.steps[axis]);
            let begin = samples.partition_point(|sample| sample.steps[axis] <= low);
            let end = samples.partition_point(|sample| sample.steps[axis] < high);
            let mut worst: Option<(f64, &GroundSample)> = None;
            for sample in samples.get(begin..end).unwrap_or_default() {
                let off_m = sample.above_chord_m([from.at_m, to.at_m]).abs();
                if off_m > worst.map_or(limit_m, |(known_m, _)| known_m) {
                    worst = Some((off_m, sample));
                }
            }
            let Some((_, sample)) = worst else { continue };
            let normal = raster.mean_normal(&sample.between);
            let vertex = MeshVertex::new(sample.steps, sample.place, normal);
            self.triangles.insert(vertex)?;
            chords.extend([[from, vertex], [vertex, to]]);
        }
        Ok(())
    }

    /// Adds vertices, and returns how many of them are new.
    pub(crate) fn insert(
        &mut self,
        vertices: impl Iterator<Item = MeshVertex>,
    ) -> Result<usize, InsertionError> {
        let before = self.triangles.num_vertices();
        for vertex in vertices {
            self.triangles.insert(vertex)?;
        }
        Ok(self.triangles.num_vertices() - before)
    }

    /// Returns the current triangles, with positions relative to `origin_m`.
    pub(crate) fn facets(&self, origin_m: [f64; 3]) -> Facets {
        Facets::new(&self.triangles, origin_m)
    }

    /// Rounds heights to the precision of the file.
    pub(crate) fn finish(&mut self) {
        let heights_m = self.triangles.vertices().map(|vertex| vertex.data().place[2]);
        self.range_m = range_of(heights_m).map(|height_m| height_m as f32);
        let vertices: Vec<FixedVertexHandle> = self.triangles.fixed_vertices().collect();
        for handle in vertices {
            let vertex = self.triangles.vertex_data_mut(handle);
            let [lon, lat, height_m] = vertex.place;
            vertex.height = quantized(height_m, self.range_m);
            vertex.at_m = geocentric_m([lon, lat, dequantized(vertex.height, self.range_m)]);
        }
    }

    /// Returns the tile: vertices sorted from the south and the west, triangles sorted, each
    /// beginning with its first vertex.
    pub(crate) fn to_tile(&self) -> QuantizedTile {
        let row_and_column = |handle: &FixedVertexHandle| {
            let [u, v] = self.triangles.vertex(*handle).data().steps;
            [v, u]
        };
        let mut order: Vec<FixedVertexHandle> = self.triangles.fixed_vertices().collect();
        order.sort_unstable_by_key(row_and_column);
        let mut number = vec![0_u32; order.len()];
        for (new, handle) in order.iter().enumerate() {
            number[handle.index()] = new as u32;
        }
        let mut triangles: Vec<[u32; 3]> = self
            .triangles
            .inner_faces()
            .map(|face| {
                let mut corners = face.vertices().map(|vertex| number[vertex.index()]);
                let first = (0..3).min_by_key(|&k| corners[k]).unwrap_or(0);
                corners.rotate_left(first);
                corners
            })
            .collect();
        triangles.sort_unstable();
        let vertices = order.iter().map(|handle| *self.triangles.vertex(*handle).data()).collect();
        QuantizedTile { vertices, triangles, range_m: self.range_m }
    }
}

impl GroundSample {
    /// Returns the vertical distance of the ground above a chord, at the place of the chord that is
    /// nearest in plan.
    fn above_chord_m(&self, [a, b]: [[f64; 3]; 2]) -> f64 {
        let in_plan = |along: [f64; 3]| {
            let rise = dot(along, self.up);
            [0, 1, 2].map(|axis| along[axis] - rise * self.up[axis])
        };
        let (along, out) = (between(a, b), between(a, self.at_m));
        let (flat, flat_out) = (in_plan(along), in_plan(out));
        let share = dot(flat, flat_out) / dot(flat, flat).max(f64::MIN_POSITIVE);
        dot(out, self.up) - share * dot(along, self.up)
    }
}

fn quantized(height_m: f64, [low, high]: [f32; 2]) -> u16 {
    let [low, high] = [low, high].map(f64::from);
    if high <= low {
        return 0;
    }
    let steps = (height_m - low) / (high - low) * f64::from(LAST_STEP);
    steps.round().clamp(0.0, f64::from(LAST_STEP)) as u16
}

fn dequantized(height: u16, [low, high]: [f32; 2]) -> f64 {
    let [low, high] = [low, high].map(f64::from);
    low + (high - low) * f64::from(height) / f64::from(LAST_STEP)
}
