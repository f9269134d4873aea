//! How far a level's triangles may be from the elevation data between its samples, as a package can tell without them.
//!
//! At samples the triangles T are within the stored error E of the data. Between four samples the data are bilinear. What is bilinear between T's own
//! heights there, B, is within E of them, too, since at no corner more than E is between both. So T is within E + |T − B| of the data, and |T − B| is
//! known: it is what the edges of triangles that go through the cell make of it.

use std::collections::HashMap;

use corniche_dem::largest_of_parabola;
use corniche_geom::{GridFrame, LatticePoint};
use corniche_tileset::Manifest;
use corniche_tin::Surface;

use crate::{dem_ground::places_between, piece::Vertex};

/// How `resampling` begins where all nodes are samples, and of one grid.
const NODES_ARE_SAMPLES: &str = "nodes are the DEM's samples";

/// The grid of the elevation files' samples over a level.
pub(crate) struct SampleCells {
    /// Lattice steps from sample to sample, east and north.
    steps: [f64; 2],
    /// How far the level is from the samples that are no nodes.
    others_m: f64,
}

impl SampleCells {
    /// `None` where the package does not tell where the samples are: its nodes are others.
    pub(crate) fn of(manifest: &Manifest, level: u8) -> Option<Self> {
        let record = manifest.levels.get(usize::from(level))?;
        let is_known =
            manifest.nodes_are_samples || manifest.resampling.starts_with(NODES_ARE_SAMPLES);
        let every = f64::from(manifest.settings.cell_every.unwrap_or(1).max(1));
        let frame = &manifest.frame;
        is_known.then(|| Self {
            steps: node_steps(frame).map(|steps| steps / every),
            others_m: if manifest.nodes_are_samples { 0.0 } else { record.sample_error.max_m },
        })
    }

    /// How far lines on the triangles of a tile, within `stored_m` of the nodes, may be from the elevation data.
    pub(crate) fn on_tile<'a>(&'a self, surface: &'a Surface, stored_m: f64) -> TileCells<'a> {
        let stored_m = stored_m.max(self.others_m);
        TileCells { steps: self.steps, stored_m, surface, corners_m: HashMap::new() }
    }
}

/// The samples beneath a tile.
pub(crate) struct TileCells<'a> {
    steps: [f64; 2],
    stored_m: f64,
    surface: &'a Surface,
    /// Heights of the triangles at samples, NaN where there are none.
    corners_m: HashMap<[i64; 2], f64>,
}

impl TileCells<'_> {
    /// The most that the elevation data can be from a line of which each segment lies on one triangle. Where the ground ends within a cell, nothing is
    /// bilinear there.
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
                // NaN leaves it as it is.
                most_m = most_m.max(largest_of_parabola(off_m(begin), off_m(middle), off_m(end)));
                begin = end;
            }
        }
        self.stored_m + most_m
    }

    /// South-west, south-east, north-west, north-east.
    fn corners_m(&mut self, cell: [f64; 2]) -> [f64; 4] {
        let [i, j] = cell.map(|index| index as i64);
        [[i, j], [i + 1, j], [i, j + 1], [i + 1, j + 1]].map(|sample| {
            let Self { steps, surface, corners_m, .. } = self;
            *corners_m.entry(sample).or_insert_with(|| {
                let at = [0, 1].map(|axis| sample[axis] as f64 * steps[axis]);
                let point = LatticePoint { u: at[0].round() as i64, v: at[1].round() as i64 };
                let triangle = surface.locate(point);
                triangle.map_or(f64::NAN, |triangle| surface.height_in_triangle_m(triangle, at))
            })
        })
    }
}

fn node_steps(frame: &GridFrame) -> [f64; 2] {
    frame.node_steps(frame.max_level()).map(|steps| steps as f64)
}

#[cfg(test)]
#[path = "between_samples_tests.rs"]
mod tests;
