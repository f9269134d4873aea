//! The positions of nodes among the DEM's samples.

use corniche_geom::{GeoTransform, GridFrame, NodeIndex, NodeWindow};
use corniche_gis::{CrsError, CrsOperation};

use crate::mosaics::mosaic::Mosaic;

/// The largest error of a position, relative to a sample or a cell, whichever is smaller.
const TOLERANCE: f64 = 0.01;
/// The stricter tolerance with which a lattice is chosen, so that most of its meshes then pass
/// [`TOLERANCE`].
const PLAN_TOLERANCE: f64 = 0.005;
/// The lattice spacings that are tried, in nodes; at 1 every node is transformed.
const STEPS: [i64; 6] = [32, 16, 8, 4, 2, 1];
/// The number of meshes tested along each side of the extent when a lattice is chosen.
const TRIAL_MESHES: i64 = 12;

/// The positions of nodes among a mosaic's samples, found through PROJ.
///
/// ```text
///   o───·───o───·───o      o  corners: nodes whose indices are multiples of `step`
///   │       │       │      ·  halfway: where interpolation between corners is worst
///   ·   ·   ·   ·   ·
///   │       │       │      Corners and halves are transformed; in a mesh whose five halves all agree with
///   o───·───o───·───o      the bilinear mean of its corners, nodes are interpolated, in others transformed.
/// ```
///
/// Meshes are those of the global grid, so a node's position depends only on its index. All five
/// halfway points are tested: with a conformal projection the errors cancel in the middle of a
/// mesh, but not on its sides.
#[derive(Debug, Clone)]
pub(crate) struct NodePositions {
    /// The operation from working metres to the mosaic's CRS, around the CRS's seam.
    crs_from_working: CrsOperation,
    crs_from_sample: GeoTransform,
    /// The number of nodes between corners of the lattice.
    pub(crate) step: i64,
    /// The tolerance, in samples.
    tolerance: f64,
}

impl NodePositions {
    /// Chooses the lattice for a mosaic whose nodes run from `south_west` to `north_east`, with
    /// `samples_per_node` samples per cell.
    pub(crate) fn new(
        mosaic: &Mosaic,
        crs_from_working: CrsOperation,
        frame: &GridFrame,
        [south_west, north_east]: [NodeIndex; 2],
        samples_per_node: f64,
    ) -> Result<Self, CrsError> {
        let scale = samples_per_node.min(1.0);
        let mut positions = Self {
            crs_from_working,
            crs_from_sample: mosaic.crs_from_sample,
            step: 1,
            tolerance: PLAN_TOLERANCE * scale,
        };
        for step in STEPS {
            positions.step = step;
            if positions.is_smooth(frame, [south_west, north_east])? {
                break;
            }
        }
        positions.tolerance = TOLERANCE * scale;
        Ok(positions)
    }

    fn is_smooth(&self, frame: &GridFrame, [low, high]: [NodeIndex; 2]) -> Result<bool, CrsError> {
        if self.step == 1 {
            return Ok(true);
        }
        let meshes = |from: i64, to: i64| {
            let (first, last) = (from.div_euclid(self.step), to.div_euclid(self.step));
            let stride = ((last - first) / TRIAL_MESHES).max(1);
            (first..=last).step_by(stride as usize)
        };
        for mesh_j in meshes(low.j, high.j) {
            for mesh_i in meshes(low.i, high.i) {
                let lattice = self.lattice(frame, [mesh_i, mesh_j], [1, 1])?;
                let is_open = lattice.halves.iter().all(|point| point[0].is_finite());
                if is_open && !lattice.is_smooth(0, 0, self.tolerance) {
                    return Ok(false);
                }
            }
        }
        Ok(true)
    }

    /// The positions of all nodes of a window, row by row from the north, in samples; NaN if there
    /// is none.
    pub(crate) fn positions_in(
        &self,
        frame: &GridFrame,
        window: &NodeWindow,
    ) -> Result<Vec<[f64; 2]>, CrsError> {
        let mut positions = vec![[f64::NAN; 2]; window.columns * window.rows];
        let (west, north) = (window.corner.i, window.corner.j);
        let (east, south) = (west + window.columns as i64 - 1, north - window.rows as i64 + 1);
        let step = self.step;
        let mut exact: Vec<usize> = Vec::new();
        if step == 1 {
            exact.extend(0..positions.len());
        } else {
            let first = [west.div_euclid(step), south.div_euclid(step)];
            let count =
                [east.div_euclid(step) - first[0] + 1, north.div_euclid(step) - first[1] + 1];
            let lattice = self.lattice(frame, first, count.map(|meshes| meshes as usize))?;
            for mesh_j in 0..count[1] {
                for mesh_i in 0..count[0] {
                    let [i0, j0] = [(first[0] + mesh_i) * step, (first[1] + mesh_j) * step];
                    let columns = i0.max(west)..(i0 + step).min(east + 1);
                    let rows = j0.max(south)..(j0 + step).min(north + 1);
                    let at = |i: i64, j: i64| {
                        (north - j) as usize * window.columns + (i - west) as usize
                    };
                    let (column, row) = (mesh_i as usize, mesh_j as usize);
                    if !lattice.is_smooth(column, row, self.tolerance) {
                        rows.for_each(|j| exact.extend(columns.clone().map(|i| at(i, j))));
                        continue;
                    }
                    let corners = lattice.corners(column, row);
                    for j in rows {
                        let v = (j - j0) as f64 / step as f64;
                        let (from, to) =
                            (mix(corners[0], corners[2], v), mix(corners[1], corners[3], v));
                        for i in columns.clone() {
                            positions[at(i, j)] = mix(from, to, (i - i0) as f64 / step as f64);
                        }
                    }
                }
            }
        }
        let mut points: Vec<[f64; 2]> = exact
            .iter()
            .map(|&at| {
                let node = window.node(at % window.columns, at / window.columns);
                [frame.x_m(node.i), frame.y_m(node.j)]
            })
            .collect();
        self.transform(&mut points)?;
        for (at, point) in exact.into_iter().zip(points) {
            positions[at] = point;
        }
        Ok(positions)
    }

    /// Transforms positions in working metres to samples, in place; NaN if there is none.
    pub(crate) fn transform(&self, points: &mut [[f64; 2]]) -> Result<(), CrsError> {
        if points.is_empty() {
            return Ok(());
        }
        self.crs_from_working.apply_to_pixels(&self.crs_from_sample, points)
    }

    fn lattice(
        &self,
        frame: &GridFrame,
        first: [i64; 2],
        meshes: [usize; 2],
    ) -> Result<Lattice, CrsError> {
        let columns = 2 * meshes[0] + 1;
        let half = self.step / 2;
        let mut halves = Vec::with_capacity(columns * (2 * meshes[1] + 1));
        for row in 0..=2 * meshes[1] as i64 {
            for column in 0..columns as i64 {
                let (i, j) =
                    (first[0] * self.step + column * half, first[1] * self.step + row * half);
                halves.push([frame.x_m(i), frame.y_m(j)]);
            }
        }
        self.transform(&mut halves)?;
        Ok(Lattice { columns, halves })
    }
}

/// Corners and halves, row by row from the south.
struct Lattice {
    columns: usize,
    halves: Vec<[f64; 2]>,
}

impl Lattice {
    fn at(&self, column: usize, row: usize) -> [f64; 2] {
        self.halves[row * self.columns + column]
    }

    /// South-west, south-east, north-west, north-east.
    fn corners(&self, mesh_i: usize, mesh_j: usize) -> [[f64; 2]; 4] {
        let (c, r) = (2 * mesh_i, 2 * mesh_j);
        [self.at(c, r), self.at(c + 2, r), self.at(c, r + 2), self.at(c + 2, r + 2)]
    }

    fn is_smooth(&self, mesh_i: usize, mesh_j: usize, tolerance: f64) -> bool {
        let [sw, se, nw, ne] = self.corners(mesh_i, mesh_j);
        let (c, r) = (2 * mesh_i, 2 * mesh_j);
        let (west, east) = (mix(sw, nw, 0.5), mix(se, ne, 0.5));
        let expected = [
            (mix(sw, se, 0.5), self.at(c + 1, r)),
            (mix(nw, ne, 0.5), self.at(c + 1, r + 2)),
            (west, self.at(c, r + 1)),
            (east, self.at(c + 2, r + 1)),
            (mix(west, east, 0.5), self.at(c + 1, r + 1)),
        ];
        // With NaN the comparison is false, too.
        expected.iter().all(|(mean, truth)| {
            (mean[0] - truth[0]).abs() <= tolerance && (mean[1] - truth[1]).abs() <= tolerance
        })
    }
}

fn mix(from: [f64; 2], to: [f64; 2], t: f64) -> [f64; 2] {
    [from[0] + (to[0] - from[0]) * t, from[1] + (to[1] - from[1]) * t]
}
