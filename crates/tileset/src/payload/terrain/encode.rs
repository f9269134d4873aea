//! Encodes the TIN of a tile as a section: positions, triangles, heights and normals.

use corniche_geom::TILE_NODES;
use corniche_tin::TinVertex;

use crate::{
    limits::{MAX_TRIANGLES, MAX_VERTICES, max_walk_steps},
    payload::{
        connectivity::{Edges, GUESSES, GateAnswer, Guesses, Guide, NAMED, NONE, walk},
        corner_guess::{GateCorner, GridVertices},
        damage::{Damage, Result, refuse_if},
        range_coder::BitWriter,
        terrain::{
            heights::code_heights,
            normals::{code_normals, guess_normals},
            positions::code_positions,
            record::{
                MAX_HEIGHT_SHIFT, MAX_NORMAL_SHIFT, Scale, TerrainSectionHead, check_measures,
            },
            symbols::Symbols,
        },
        tile_payload::TileTerrain,
        work_limit::StepBudget,
    },
};

/// Encodes the section; an error describes what cannot be encoded.
pub(crate) fn encode(terrain: &TileTerrain, scale: Scale) -> Result<Vec<u8>, &'static str> {
    let vertices = terrain.tin.vertices();
    refuse_if(
        vertices.len() != terrain.normals.len(),
        "a number of normals that is not the number of vertices",
    )?;
    refuse_if(
        vertices.iter().any(|v| usize::from(v.row.max(v.column)) >= TILE_NODES),
        "vertices outside the tile's grid",
    )?;
    let triangles = terrain.tin.triangles();
    check_measures(
        terrain.geometric_error_m,
        terrain.height_range_m,
        terrain.uncovered_nodes,
        scale,
    )?;
    refuse_if(
        vertices.len() > MAX_VERTICES || triangles.len() > MAX_TRIANGLES,
        "more triangles than a tile has cells for",
    )?;
    let (height_shift, normal_shift) = common_factors(vertices, &terrain.normals);
    let record = TerrainSectionHead {
        geometric_error_m: terrain.geometric_error_m,
        height_range_m: terrain.height_range_m,
        uncovered_nodes: terrain.uncovered_nodes,
        triangles: triangles.len(),
        height_shift,
        normal_shift,
    };
    let mut bits = BitWriter::new(record.to_bytes());

    let mut nodes_of_vertices =
        vertices.iter().map(|v| usize::from(v.row) * TILE_NODES + usize::from(v.column)).peekable();
    let mut node = 0..;
    let at = code_positions(&mut bits, || {
        nodes_of_vertices.next_if_eq(&node.next().unwrap_or(0)).is_some()
    });
    refuse_if(at.len() != vertices.len(), "vertices that are not sorted")?;

    // The limit is that of a reader: the writer takes at least as many steps as a reader.
    let work = StepBudget::new(max_walk_steps(vertices.len(), triangles.len()));
    let nodes = GridVertices::new(at.iter().copied(), &work);
    let mut recorder = TerrainRecorder::new(vertices.len(), triangles, &mut bits);
    let (found, order) =
        walk(&nodes, triangles.len(), &mut recorder).map_err(|damage| match damage {
            Damage::TooMuchWork { .. } => "triangles whose decoding takes too many steps",
            _ => "an edge with several triangles on one side",
        })?;

    let mut heights: Vec<i32> = vertices.iter().map(|v| v.height_q >> height_shift).collect();
    code_heights(&mut bits, &at, &order, &mut heights).map_err(|_| "a height")?;

    let guesses = guess_normals(vertices, &found, scale, normal_shift);
    code_normals(&mut bits, &order, &guesses, normal_shift, &mut terrain.normals.clone());
    Ok(bits.finish())
}

/// Returns the exponents of the largest powers of two that divide all heights, and all normals.
fn common_factors(vertices: &[TinVertex], normals: &[[i8; 2]]) -> (u8, u8) {
    let heights = vertices.iter().fold(0, |all, vertex| all | vertex.height_q);
    let steps = normals.iter().flatten().fold(0, |all, &step| all | step);
    let shift = |zeros: u32, is_zero: bool, most: u8| {
        if is_zero { 0 } else { (zeros as u8).min(most) }
    };
    (
        shift(heights.trailing_zeros(), heights == 0, MAX_HEIGHT_SHIFT),
        shift(steps.trailing_zeros(), steps == 0, MAX_NORMAL_SHIFT),
    )
}

/// The corners of the triangles to the left of edges, by the edge's origin.
struct Corners {
    /// The start of the edges of each origin, and the end of the last list.
    starts: Vec<u32>,
    /// The target and the corner of each edge.
    edges: Vec<[u32; 2]>,
}

/// Lists with more edges are sorted, so that a vertex with a thousand triangles is not slow.
const LONG_LIST: usize = 32;

impl Corners {
    /// Creates the lists; the triangles refer to vertices below `vertices`.
    fn new(vertices: usize, triangles: &[[u32; 3]]) -> Self {
        // The counts are stored two entries ahead, so that filling moves each start to its
        // position.
        let mut starts = vec![0_u32; vertices + 2];
        for &vertex in triangles.iter().flatten() {
            starts[vertex as usize + 2] += 1;
        }
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        let mut edges = vec![[0; 2]; 3 * triangles.len()];
        for &[a, b, c] in triangles {
            for [origin, target, corner] in [[a, b, c], [b, c, a], [c, a, b]] {
                let end = &mut starts[origin as usize + 1];
                edges[*end as usize] = [target, corner];
                *end += 1;
            }
        }
        for ends in starts.windows(2) {
            let edges = &mut edges[ends[0] as usize..ends[1] as usize];
            if edges.len() > LONG_LIST {
                edges.sort_unstable();
            }
        }
        Self { starts, edges }
    }

    /// Returns the corner to the left of a ► b.
    fn corner_between(&self, a: u32, b: u32) -> Option<u32> {
        let a = a as usize;
        let edges = &self.edges[self.starts[a] as usize..self.starts[a + 1] as usize];
        let found = if edges.len() > LONG_LIST {
            edges.binary_search_by_key(&b, |&[target, _]| target).ok()
        } else {
            edges.iter().position(|&[target, _]| target == b)
        };
        found.map(|place| edges[place][1])
    }
}

/// Finds triangles by looking them up, and writes the symbols.
///
/// If two triangles are on the same side of an edge, it finds only one of them, and the walk fails.
pub(crate) struct TerrainRecorder<'a> {
    triangles: &'a [[u32; 3]],
    /// The triangles before this index have been found.
    next: usize,
    corners: Corners,
    symbols: Symbols,
    bits: &'a mut BitWriter,
    last: u32,
}

impl<'a> TerrainRecorder<'a> {
    pub(crate) fn new(vertices: usize, triangles: &'a [[u32; 3]], bits: &'a mut BitWriter) -> Self {
        let corners = Corners::new(vertices, triangles);
        Self { triangles, next: 0, corners, symbols: Symbols::new(vertices), bits, last: 0 }
    }
}

impl Guide for TerrainRecorder<'_> {
    fn start(&mut self, found: &Edges<'_>) -> Result<[u32; 3]> {
        let rest = &self.triangles[self.next..];
        let skip = rest.iter().position(|&[a, b, _]| !found.has(a, b));
        self.next += skip.ok_or(Damage::Invalid("number of triangles"))?;
        let [a, b, c] = self.triangles[self.next];
        // Triangles are in canonical order: each starts with its smallest vertex, and they are
        // sorted.
        for gap in [a - self.last, b - a - 1, c - a - 1] {
            self.symbols.number(self.bits, gap)?;
        }
        self.last = a;
        Ok([a, b, c])
    }

    fn corner(&mut self, guesses: &Guesses<'_, '_>) -> Result<GateAnswer> {
        let [a, b, _] = guesses.gate;
        let corner = self.corners.corner_between(a, b);
        let Some(first) = guesses.first() else {
            // Without a candidate, there is no triangle here, or it is not counter-clockwise.
            return if corner.is_none() {
                Ok(GateAnswer::Nothing)
            } else {
                Err(Damage::Invalid("a triangle's vertex"))
            };
        };
        let symbol = corner.map_or(NONE, |actual| rank(actual, first, guesses));
        self.symbols.code(self.bits, guesses, first, symbol);
        match (corner, symbol) {
            (None, _) => Ok(GateAnswer::Nothing),
            (Some(actual), NAMED) => {
                self.symbols.number(self.bits, actual)?;
                Ok(GateAnswer::Named(actual))
            }
            (Some(actual), _) => Ok(GateAnswer::Guessed(actual)),
        }
    }
}

/// The rank of the guess that is the vertex; [`NAMED`] if no guess with a symbol is the vertex.
fn rank(actual: u32, first: GateCorner, guesses: &Guesses<'_, '_>) -> u8 {
    if first.vertex == actual {
        return 1;
    }
    let mut no = vec![first.vertex];
    for rank in 2..=GUESSES {
        match guesses.best_but(&no) {
            Some(corner) if corner.vertex == actual => return rank,
            Some(corner) => no.push(corner.vertex),
            None => break,
        }
    }
    NAMED
}
