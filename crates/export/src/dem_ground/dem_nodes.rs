//! Heights of the elevation files at any place, from blocks of nodes.

use std::{
    collections::{HashMap, VecDeque},
    rc::Rc,
};

use corniche_dem::{Reader, SampleSurface};
use corniche_geom::{GridFrame, NodeIndex, NodeWindow};

use crate::{error::ElevationError, heights::Elevation, piece::Vertex};

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
    pub(crate) steps: [f64; 2],
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
    pub(crate) fn farthest_m(&mut self, line: &[Vertex]) -> Result<Option<f64>, ElevationError> {
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

/// A height between two, of which one counts alone at its own place.
fn mix(from: f64, to: f64, share: f64) -> f64 {
    if share <= 0.0 {
        from
    } else if share >= 1.0 {
        to
    } else {
        from + share * (to - from)
    }
}
