//! An upper bound for the distance of a level's triangles from the elevation data between its
//! samples, computed from the package alone.
//!
//! At samples, the triangles T are within the stored error E of the data. Between four samples the
//! data are bilinear. Let B be the bilinear surface through T's own heights at these samples. B is
//! within E of the data everywhere, because it is at each corner. So T is within E + |T − B| of the
//! data, and |T − B| is known: it follows from the triangle edges that cross the cell.

use std::collections::HashMap;

use corniche_dem::largest_of_parabola;
use corniche_tileset::Manifest;
use corniche_tin::Surface;

use crate::{
    dem_ground::{node_steps, places_between},
    piece::Vertex,
    plane::nearest_point,
};

/// The beginning of `resampling` in the manifest if all grid nodes are samples of one DEM grid.
const NODES_ARE_SAMPLES: &str = "nodes are the DEM's samples";

/// The samples of the elevation files beneath a tile.
pub(crate) struct TileCells<'a> {
    /// Lattice steps from sample to sample, east and north.
    steps: [f64; 2],
    /// The largest distance of the triangles from the samples, metres.
    stored_m: f64,
    surface: &'a Surface,
    /// Heights of the triangles at samples; NaN where there is no ground.
    corners_m: HashMap<[i64; 2], f64>,
}

impl<'a> TileCells<'a> {
    /// Returns the samples beneath the triangles of a tile, which are within `stored_m` of the grid
    /// nodes. Returns `None` if the package does not record where the samples are, because its grid
    /// nodes are at other positions.
    pub(crate) fn from_level(
        manifest: &Manifest,
        level: u8,
        surface: &'a Surface,
        stored_m: f64,
    ) -> Option<Self> {
        let record = manifest.levels.get(usize::from(level))?;
        let are_nodes = manifest.nodes_are_samples;
        let every = f64::from(manifest.settings.cell_every.unwrap_or(1).max(1));
        (are_nodes || manifest.resampling.starts_with(NODES_ARE_SAMPLES)).then(|| Self {
            steps: node_steps(&manifest.frame).map(|steps| steps / every),
            stored_m: if are_nodes { stored_m } else { stored_m.max(record.sample_error.max_m) },
            surface,
            corners_m: HashMap::new(),
        })
    }

    /// Returns the largest possible distance between the elevation data and a line each segment of
    /// which is on one triangle. Cells in which the ground ends are not bilinear and do not count.
    pub(crate) fn bound_m(&mut self, line: &[Vertex]) -> f64 {
        let mut most_m = 0.0_f64;
        for [from, to] in line.array_windows::<2>() {
            let mut begin = from.at;
            for [middle, end] in places_between(from.at, to.at, self.steps) {
                let cell = [0, 1].map(|axis| (middle[axis] / self.steps[axis]).floor());
                let corners_m = self.corners_m(cell);
                let off_m = |at: [f64; 2]| {
                    let [across, along] =
                        [0, 1].map(|axis| at[axis] / self.steps[axis] - cell[axis]);
                    let [sw, se, nw, ne] = corners_m;
                    let (south, north) = (sw + across * (se - sw), nw + across * (ne - nw));
                    from.height_m_at(*to, at) - south - along * (north - south)
                };
                // `f64::max` ignores NaN.
                most_m = most_m.max(largest_of_parabola(off_m(begin), off_m(middle), off_m(end)));
                begin = end;
            }
        }
        self.stored_m + most_m
    }

    /// Returns the heights of the corners: south-west, south-east, north-west, north-east.
    fn corners_m(&mut self, cell: [f64; 2]) -> [f64; 4] {
        let [i, j] = cell.map(|index| index as i64);
        [[i, j], [i + 1, j], [i, j + 1], [i + 1, j + 1]].map(|sample| {
            let Self { steps, surface, corners_m, .. } = self;
            *corners_m.entry(sample).or_insert_with(|| {
                let at = [0, 1].map(|axis| sample[axis] as f64 * steps[axis]);
                let triangle = surface.locate(nearest_point(at));
                triangle.map_or(f64::NAN, |triangle| surface.height_in_triangle_m(triangle, at))
            })
        })
    }
}

#[cfg(test)]
#[path = "between_samples_tests.rs"]
mod tests;
