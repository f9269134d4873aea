//! The ground of the elevation files themselves, bilinear between their samples, and lines draped
//! on it.
//!
//! ```text
//!   ┌──────┬──────┬──────┐      ●  a point of the line
//!   │   ●╌╌┼╌x╌╌╌╌┼──●   │      │  the line crosses from cell to cell: a vertex
//!   └──────┴──────┴──────┘      x  the middle of the part in a cell: a vertex
//! ```
//!
//! Along a straight line the bilinear surface of a cell is a parabola, which a vertex in its middle
//! approximates closely. The distance of the line from the surface of the files' own samples is
//! measured, because grid nodes need not be samples. In this module, a node is a node of the grid.

use std::{
    collections::{HashMap, VecDeque},
    rc::Rc,
};

use corniche_dem::{HeightReader, SampleSurface};
use corniche_geom::{GridFrame, NodeIndex, NodeWindow};

use crate::{
    error::ElevationError,
    heights::Elevation,
    piece::{Vertex, own_points},
    plane::{middle, mix},
};

/// Cells along each side of a block.
const BLOCK_CELLS: i64 = 64;
/// The number of blocks in the cache: 17 MB.
const MOST_BLOCKS: usize = 1024;

/// Heights at the nodes of a block, row by row from the north.
type HeightBlock = Rc<[f32]>;

/// The surface over the nodes of a package's grid, with the heights of its elevation files:
/// bilinear in each cell.
pub(crate) struct DemNodes<'a> {
    reader: HeightReader<'a>,
    /// The surface of the files' own samples, which may differ from the nodes.
    samples: SampleSurface<'a>,
    pub(crate) frame: GridFrame,
    /// Lattice steps from node to node, east and north.
    steps: [f64; 2],
    kept: HashMap<[i64; 2], HeightBlock>,
    /// The blocks in the cache, the oldest first.
    order: VecDeque<[i64; 2]>,
}

impl<'a> DemNodes<'a> {
    pub(crate) fn new(elevation: Elevation<'a>, frame: &GridFrame) -> Self {
        Self {
            reader: elevation.dem.reader(elevation.plan),
            samples: elevation.dem.sample_surface(elevation.plan),
            frame: *frame,
            steps: node_steps(frame),
            kept: HashMap::new(),
            order: VecDeque::new(),
        }
    }

    /// Returns the block that contains a place.
    pub(crate) fn block_of(&self, at: [f64; 2]) -> [i64; 2] {
        let cell = [0, 1].map(|axis| (at[axis] / self.steps[axis]).floor() as i64);
        cell.map(|index| index.div_euclid(BLOCK_CELLS))
    }

    /// Returns the height at a place on the lattice, or `None` if one of the nodes around it has no
    /// height. The height is the same to the last bit, whichever cell a line comes from.
    pub(crate) fn height_m(&mut self, at: [f64; 2]) -> Result<Option<f64>, ElevationError> {
        let in_cells = [at[0] / self.steps[0], at[1] / self.steps[1]];
        let cell = in_cells.map(f64::floor);
        let [east, north] = [in_cells[0] - cell[0], in_cells[1] - cell[1]];
        let [i, j] = cell.map(|index| index as i64);
        let mut row = |j: i64| -> Result<f64, ElevationError> {
            let west = if east < 1.0 { self.node_m([i, j])? } else { 0.0 };
            let beyond = if east > 0.0 { self.node_m([i + 1, j])? } else { 0.0 };
            Ok(mix(west, beyond, east))
        };
        let south = if north < 1.0 { row(j)? } else { 0.0 };
        let beyond = if north > 0.0 { row(j + 1)? } else { 0.0 };
        let height_m = mix(south, beyond, north);
        Ok(height_m.is_finite().then_some(height_m))
    }

    /// Returns the largest distance of a line from the surface of the files' own samples, over the
    /// whole line, metres; `None` if no part of it is on that surface. Every second vertex is the
    /// middle of a straight part.
    fn farthest_m(&mut self, line: &[Vertex]) -> Result<Option<f64>, ElevationError> {
        let place = |vertex: &Vertex| {
            let [x, y] = self.frame.position_of_fraction_m(vertex.at);
            [x, y, vertex.z_m]
        };
        let line: Vec<[f64; 3]> = line.iter().map(place).collect();
        Ok(self.samples.largest_distance_m(&line)?)
    }

    /// The height of a node; NaN where there is none.
    fn node_m(&mut self, [i, j]: [i64; 2]) -> Result<f64, ElevationError> {
        let number = [i, j].map(|index| index.div_euclid(BLOCK_CELLS));
        let block = match self.kept.get(&number) {
            Some(block) => Rc::clone(block),
            None => self.read(number)?,
        };
        let [column, row] = [i - number[0] * BLOCK_CELLS, j - number[1] * BLOCK_CELLS];
        let from_north = BLOCK_CELLS - 1 - row;
        Ok(f64::from(block[(from_north * BLOCK_CELLS + column) as usize]))
    }

    fn read(&mut self, number: [i64; 2]) -> Result<HeightBlock, ElevationError> {
        let side = BLOCK_CELLS as usize;
        let [i, j] = number.map(|number| number * BLOCK_CELLS);
        let corner = NodeIndex { i, j: j + BLOCK_CELLS - 1 };
        let window = NodeWindow { corner, stride: 1, columns: side, rows: side };
        let block: HeightBlock = self.reader.window(window)?.heights.raw().into();
        if self.order.len() >= MOST_BLOCKS
            && let Some(oldest) = self.order.pop_front()
        {
            self.kept.remove(&oldest);
        }
        self.order.push_back(number);
        self.kept.insert(number, Rc::clone(&block));
        Ok(block)
    }
}

/// Crossings closer together than this, lattice steps, are one crossing: a node of the grid.
const SAME_PLACE_STEPS: f64 = 1e-3;

/// A line on the ground of the elevation files, without a gap.
pub(crate) struct DemLine {
    /// At least two vertices.
    pub(crate) vertices: Vec<Vertex>,
    /// The largest distance of the line from the surface of the files' own samples, metres; `None`
    /// if no part of it is on that surface.
    pub(crate) tolerance_m: Option<f64>,
    /// Whether its first vertex is the first of the whole line, and its last the last.
    pub(crate) has_end: [bool; 2],
    /// Whether the line is on a deck instead.
    pub(crate) on_deck: bool,
}

impl DemLine {
    fn from(first: Vertex, is_first: bool) -> Self {
        let has_end = [is_first, false];
        Self { vertices: vec![first], tolerance_m: None, has_end, on_deck: false }
    }
}

/// Drapes a line on the ground. Only its ends and those of its vertices that are source points
/// determine its course. Where there is no ground, the line has a gap.
pub(crate) fn lay(
    nodes: &mut DemNodes<'_>,
    line: &[Vertex],
) -> Result<Vec<DemLine>, ElevationError> {
    let points: Vec<Vertex> = own_points(line).map(|(_, vertex)| *vertex).collect();
    let mut lines: Vec<DemLine> = Vec::new();
    // Whether the last line may continue.
    let mut is_open = false;
    for (number, pair) in points.array_windows::<2>().enumerate() {
        let [from, to] = *pair;
        let places = places_between(from.at, to.at, nodes.steps);
        let mut before = nodes.height_m(from.at)?;
        if let Some(z_m) = before.filter(|_| !is_open) {
            lines.push(DemLine::from(Vertex { z_m, ..from }, number == 0));
        }
        is_open = before.is_some();
        let ends = places.len() - 1;
        for (index, [middle, end]) in places.iter().enumerate() {
            let is_source = index == ends && to.is_source;
            let [middle_m, end_m] = [nodes.height_m(*middle)?, nodes.height_m(*end)?];
            let next = end_m.map(|z_m| Vertex { at: *end, z_m, is_source });
            if let (Some(_), Some(z_m), Some(next)) = (before, middle_m, next)
                && let Some(line) = lines.last_mut()
            {
                line.vertices.extend([Vertex { at: *middle, z_m, is_source: false }, next]);
            } else {
                // The ground ends before this end, which begins a new line if it has ground itself.
                is_open = next.is_some();
                lines.extend(next.map(|vertex| DemLine::from(vertex, false)));
            }
            before = end_m;
        }
    }
    let is_long = |line: &DemLine| line.vertices.len() >= 2;
    if let Some(line) = lines.last_mut().filter(|line| is_open && is_long(line)) {
        line.has_end[1] = true;
    }
    lines.retain(is_long);
    for line in &mut lines {
        line.tolerance_m = nodes.farthest_m(&line.vertices)?;
    }
    Ok(lines)
}

/// Returns the largest distance between a line on a package's triangles and the ground of the
/// elevation files, over the whole line, metres; `None` if no part of it is on ground with samples.
pub(crate) fn off_dem_m(
    nodes: &mut DemNodes<'_>,
    line: &[Vertex],
) -> Result<Option<f64>, ElevationError> {
    let mut divided: Vec<Vertex> = line.first().copied().into_iter().collect();
    for [from, to] in line.array_windows::<2>() {
        let on_line = |at| Vertex { at, z_m: from.height_m_at(*to, at), is_source: false };
        divided.extend(
            places_between(from.at, to.at, nodes.steps).into_flattened().into_iter().map(on_line),
        );
    }
    nodes.farthest_m(&divided)
}

/// Lattice steps from node to node of the finest level, east and north.
pub(crate) fn node_steps(frame: &GridFrame) -> [f64; 2] {
    frame.node_steps(frame.max_level()).map(|steps| steps as f64)
}

/// Divides the way between two places cell by cell: the middle and the end of each part. The last
/// end is the second place. The places are the same in both directions.
pub(crate) fn places_between(from: [f64; 2], to: [f64; 2], steps: [f64; 2]) -> Vec<[[f64; 2]; 2]> {
    let is_turned = from > to;
    let [low, high] = if is_turned { [to, from] } else { [from, to] };
    let mut places = vec![low];
    places.extend(crossings(low, high, steps));
    places.push(high);
    if is_turned {
        places.reverse();
    }
    places.array_windows().map(|&[a, b]| [middle(a, b), b]).collect()
}

/// Returns the points at which a segment crosses lines of the grid, in its direction, without its
/// ends.
fn crossings(from: [f64; 2], to: [f64; 2], steps: [f64; 2]) -> Vec<[f64; 2]> {
    let mut found: Vec<(f64, [f64; 2])> = Vec::new();
    for axis in 0..2 {
        let other = 1 - axis;
        let [low, high] = [from[axis].min(to[axis]), from[axis].max(to[axis])];
        let run = to[axis] - from[axis];
        let mut line = (low / steps[axis]).floor() + 1.0;
        while line * steps[axis] < high {
            let share = (line * steps[axis] - from[axis]) / run;
            let mut at = [0.0; 2];
            at[axis] = line * steps[axis];
            at[other] = from[other] + share * (to[other] - from[other]);
            found.push((share, at));
            line += 1.0;
        }
    }
    found.sort_by(|one, other| one.0.total_cmp(&other.0));
    let mut places: Vec<[f64; 2]> = Vec::with_capacity(found.len());
    for (_, at) in found {
        match places.last_mut() {
            Some(last)
                if (last[0] - at[0]).abs() < SAME_PLACE_STEPS
                    && (last[1] - at[1]).abs() < SAME_PLACE_STEPS =>
            {
                // Both are on lines of the grid, so this is a node.
                *last = [0, 1].map(|axis| (at[axis] / steps[axis]).round() * steps[axis]);
            }
            _ => places.push(at),
        }
    }
    places
}

#[cfg(test)]
#[path = "dem_ground_tests.rs"]
mod tests;
