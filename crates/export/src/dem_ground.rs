//! The ground of the elevation files themselves, bilinear between their samples, and lines that lie on it.
//!
//! ```text
//!   ┌──────┬──────┬──────┐      ●  a point of the line
//!   │   ●╌╌┼╌x╌╌╌╌┼──●   │      │  the line crosses from cell to cell: a vertex
//!   └──────┴──────┴──────┘      x  the middle of what lies in a cell: a vertex
//! ```
//!
//! Along a straight line the bilinear surface of a cell is a parabola, which a vertex in its middle follows nearly. How far the line is from the
//! surface of the files' own samples is measured, since nodes need not be samples.

use std::{
    collections::{HashMap, VecDeque},
    rc::Rc,
};

use corniche_dem::{Reader, SampleSurface};
use corniche_geom::{GridFrame, NodeIndex, NodeWindow};

use crate::{
    error::ElevationError,
    heights::Elevation,
    piece::Vertex,
    plane::{middle, mix},
};

/// Cells along each side of a block.
const BLOCK_CELLS: i64 = 64;
/// Blocks that are kept: 17 MB.
const MOST_BLOCKS: usize = 1024;

/// Heights at the nodes of a block, row by row from the north.
type Block = Rc<[f32]>;

/// The surface over the nodes of a package's grid, as its elevation files have them: bilinear in each cell.
pub(crate) struct DemNodes<'a> {
    reader: Reader<'a>,
    /// The surface of the files' own samples, which may be others than the nodes.
    samples: SampleSurface<'a>,
    pub(crate) frame: GridFrame,
    /// Lattice steps from node to node, east and north.
    steps: [f64; 2],
    kept: HashMap<[i64; 2], Block>,
    /// The blocks that are kept, the oldest first.
    order: VecDeque<[i64; 2]>,
}

impl<'a> DemNodes<'a> {
    pub(crate) fn new(elevation: Elevation<'a>, frame: &GridFrame) -> Self {
        Self {
            reader: elevation.dem.reader(elevation.plan),
            samples: elevation.dem.sample_surface(elevation.plan),
            frame: *frame,
            steps: frame.node_steps(frame.max_level()).map(|steps| steps as f64),
            kept: HashMap::new(),
            order: VecDeque::new(),
        }
    }

    /// The block in which a place lies.
    pub(crate) fn block_of(&self, at: [f64; 2]) -> [i64; 2] {
        let cell = [0, 1].map(|axis| (at[axis] / self.steps[axis]).floor() as i64);
        cell.map(|index| index.div_euclid(BLOCK_CELLS))
    }

    /// The height at a place on the lattice; `None` where a node that it needs has none. The same place has the same height to the last bit, from
    /// whatever cell a line comes.
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

    /// How far a line is from the surface of the files' own samples, at most, over the whole line, metres; `None` where no part of it lies on that.
    /// Of its vertices each second one is the middle of a straight part.
    fn farthest_m(&mut self, line: &[Vertex]) -> Result<Option<f64>, ElevationError> {
        let place = |vertex: &Vertex| {
            let [x, y] = self.frame.position_of_fraction_m(vertex.at);
            [x, y, vertex.z_m]
        };
        let line: Vec<[f64; 3]> = line.iter().map(place).collect();
        let found = self.samples.largest_distance_m(&line);
        found.map_err(|source| ElevationError::Read(Box::new(source)))
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

    fn read(&mut self, number: [i64; 2]) -> Result<Block, ElevationError> {
        let side = BLOCK_CELLS as usize;
        let [i, j] = number.map(|number| number * BLOCK_CELLS);
        let corner = NodeIndex { i, j: j + BLOCK_CELLS - 1 };
        let window = NodeWindow { corner, stride: 1, columns: side, rows: side };
        let read = self.reader.window(window);
        let read = read.map_err(|source| ElevationError::Read(Box::new(source)))?;
        let block: Block = read.heights.raw().into();
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

/// Crossings that are nearer to each other than this, lattice steps, are one: a node of the grid.
const SAME_PLACE_STEPS: f64 = 1e-3;

/// A line on the ground of the elevation files, without a gap.
#[derive(Clone)]
pub(crate) struct DemLine {
    /// Two at least.
    pub(crate) vertices: Vec<Vertex>,
    /// How far the line is from the surface of the files' own samples, at most, metres; `None` where nothing of it lies on that.
    pub(crate) tolerance_m: Option<f64>,
    /// Whether its first vertex is that of the whole line, and its last the last.
    pub(crate) has_end: [bool; 2],
    /// Whether a deck carries it instead.
    pub(crate) on_deck: bool,
}

impl DemLine {
    fn from(first: Vertex, is_first: bool) -> Self {
        let has_end = [is_first, false];
        Self { vertices: vec![first], tolerance_m: None, has_end, on_deck: false }
    }
}

/// Lays a line on the ground: of its vertices, those that are source points, and its ends, tell where it runs. Where there is no ground it has a gap.
pub(crate) fn lay(
    nodes: &mut DemNodes<'_>,
    line: &[Vertex],
) -> Result<Vec<DemLine>, ElevationError> {
    let last = line.len().saturating_sub(1);
    let is_kept =
        |(index, vertex): &(usize, &Vertex)| vertex.is_source || *index == 0 || *index == last;
    let points: Vec<Vertex> =
        line.iter().enumerate().filter(is_kept).map(|(_, vertex)| *vertex).collect();
    let mut laid = Laid::default();
    for (number, pair) in points.array_windows::<2>().enumerate() {
        let [from, to] = *pair;
        let places = places_between(from.at, to.at, nodes.steps);
        let mut before = laid.begin(nodes, from, number == 0)?;
        let ends = places.len() - 1;
        for (index, [middle, end]) in places.iter().enumerate() {
            let is_end = index == ends;
            let middle_m = nodes.height_m(*middle)?;
            let end_m = nodes.height_m(*end)?;
            if let (Some(_), Some(middle_m), Some(end_m)) = (before, middle_m, end_m) {
                let inner = Vertex { at: *middle, z_m: middle_m, is_source: false };
                let is_source = is_end && to.is_source;
                laid.go_on(inner, Vertex { at: *end, z_m: end_m, is_source });
            } else {
                let is_source = is_end && to.is_source;
                laid.interrupt(end_m.map(|z_m| Vertex { at: *end, z_m, is_source }));
            }
            before = end_m;
        }
    }
    let reaches_end =
        laid.is_open && laid.lines.last().is_some_and(|line| line.vertices.len() >= 2);
    laid.lines.retain(|line| line.vertices.len() >= 2);
    if let Some(line) = laid.lines.last_mut().filter(|_| reaches_end) {
        line.has_end[1] = true;
    }
    for line in &mut laid.lines {
        line.tolerance_m = nodes.farthest_m(&line.vertices)?;
    }
    Ok(laid.lines)
}

#[derive(Default)]
struct Laid {
    lines: Vec<DemLine>,
    /// Whether the last line goes on.
    is_open: bool,
}

impl Laid {
    /// A segment begins at a point. Returns the height there.
    fn begin(
        &mut self,
        nodes: &mut DemNodes<'_>,
        from: Vertex,
        is_first: bool,
    ) -> Result<Option<f64>, ElevationError> {
        let height_m = nodes.height_m(from.at)?;
        if let Some(z_m) = height_m.filter(|_| !self.is_open) {
            self.lines.push(DemLine::from(Vertex { z_m, ..from }, is_first));
        }
        self.is_open = height_m.is_some();
        Ok(height_m)
    }

    fn go_on(&mut self, middle: Vertex, end: Vertex) {
        if let Some(line) = self.lines.last_mut() {
            line.vertices.extend([middle, end]);
        }
    }

    /// There is no ground somewhere before a place, which begins a new line if it has ground itself.
    fn interrupt(&mut self, next: Option<Vertex>) {
        self.is_open = next.is_some();
        self.lines.extend(next.map(|vertex| DemLine::from(vertex, false)));
    }
}

/// How far a line on a package's triangles is from the ground of the elevation files, at most, over the whole line, metres; `None` where no part of
/// it lies on such ground.
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

/// What lies between two places, cell by cell: the middle and the end of each part. The last end is the second place. The places are the same in both
/// directions.
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

/// Where a segment crosses lines of the grid, in its direction; not its ends.
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
                // Both lie on lines of the grid, so this is a node.
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
