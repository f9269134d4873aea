use corniche_geom::TILE_NODES;
use corniche_tin::TinVertex;

use crate::limits::{MAX_TRIANGLES, MAX_VERTICES, max_walk_steps};
use crate::payload::connectivity::{Edges, GUESSES, Guide, NAMED, NONE, Reached, walk};
use crate::payload::corner_guess::Nodes;
use crate::payload::damage::Damage;
use crate::payload::number_codes::{put_planes, put_varint, zigzag};
use crate::payload::terrain::guess::{guess_height, guess_normals};
use crate::payload::terrain::record::{Record, Scale, check_measures};
use crate::payload::tile_payload::Terrain;
use crate::payload::work_limit::Work;

/// The section's bytes, or what of the ground cannot be encoded.
pub(crate) fn encode(terrain: &Terrain, scale: Scale) -> Result<Vec<u8>, &'static str> {
    let vertices = terrain.tin.vertices();
    if vertices.len() != terrain.normals.len() {
        return Err("normals that are not one for each vertex");
    }
    if vertices.iter().any(|v| usize::from(v.row.max(v.column)) >= TILE_NODES) {
        return Err("vertices outside the tile's grid");
    }
    let triangles = terrain.tin.triangles();
    check_measures(
        terrain.geometric_error_m,
        terrain.height_range_m,
        terrain.uncovered_nodes,
        scale,
    )?;
    if vertices.len() > MAX_VERTICES || triangles.len() > MAX_TRIANGLES {
        return Err("more triangles than a tile has cells for");
    }
    let at: Vec<[u16; 2]> = vertices.iter().map(|v| [v.column, v.row]).collect();
    // The same limit as a reader's: the writer takes at least as many steps as a reader.
    let work = Work::new(max_walk_steps(vertices.len(), triangles.len()));
    let nodes = Nodes::new(at.iter().copied(), &work);
    let lookups = Work::new(u64::MAX);
    let mut recorder = Recorder::new(vertices.len(), triangles, &lookups)
        .map_err(|_| "an edge with several triangles on one side")?;
    let (found, order) =
        walk(&nodes, triangles.len(), &mut recorder).map_err(|damage| match damage {
            Damage::TooMuchWork { .. } => "triangles that take readers too many steps to find",
            _ => "an edge with several triangles on one side",
        })?;
    let factors = vertices.iter().fold(0, |all, vertex| all | vertex.height_q);
    let height_shift = if factors == 0 { 0 } else { factors.trailing_zeros() as u8 };
    let record = Record {
        geometric_error_m: terrain.geometric_error_m,
        height_range_m: terrain.height_range_m,
        uncovered_nodes: terrain.uncovered_nodes,
        vertices: vertices.len() as u32,
        triangles: triangles.len() as u32,
        symbols: recorder.symbols.len() as u32,
        named: recorder.named.len() as u32,
        height_shift,
    };
    let mut out = bincode::serde::encode_to_vec(&record, bincode::config::legacy())
        .map_err(|_| "the record of the section")?;
    put_nodes(&mut out, &at);
    out.extend(&recorder.symbols);
    out.extend(&recorder.named);
    put_planes(&mut out, &height_residuals(vertices, &order, height_shift));
    let guesses = guess_normals(vertices, &found, scale);
    for axis in 0..2 {
        let residual =
            |(normal, guess): (&[i8; 2], &[i8; 2])| normal[axis].wrapping_sub(guess[axis]) as u8;
        out.extend(terrain.normals.iter().zip(&guesses).map(residual));
    }
    Ok(out)
}

/// Heights minus their guesses, in the order of the walk.
fn height_residuals(vertices: &[TinVertex], order: &[Reached], height_shift: u8) -> Vec<u64> {
    let mut heights = vec![0; vertices.len()];
    let mut previous = 0;
    let residual = |reached: &Reached| {
        let guess = guess_height(reached, &heights, previous);
        previous = vertices[reached.vertex as usize].height_q >> height_shift;
        heights[reached.vertex as usize] = previous;
        zigzag(i64::from(previous.wrapping_sub(guess)))
    };
    order.iter().map(residual).collect()
}

fn put_nodes(out: &mut Vec<u8>, at: &[[u16; 2]]) {
    let mut per_row = [0; TILE_NODES];
    for node in at {
        per_row[usize::from(node[1])] += 1;
    }
    for count in per_row {
        put_varint(out, count);
    }
    let mut next = [0, 0];
    for &[column, row] in at {
        let expected = if next[1] == row { next[0] } else { 0 };
        put_varint(out, u64::from(column - expected));
        next = [column + 1, row];
    }
}

/// Finds triangles by looking them up, and writes the symbols.
pub(crate) struct Recorder<'a> {
    triangles: &'a [[u32; 3]],
    /// Triangles before this one have been found.
    next: usize,
    edges: Edges<'a>,
    symbols: Vec<u8>,
    named: Vec<u8>,
    last: u32,
}

impl<'a> Recorder<'a> {
    pub(crate) fn new(
        vertices: usize,
        triangles: &'a [[u32; 3]],
        work: &'a Work,
    ) -> Result<Self, Damage> {
        let mut edges = Edges::new(vertices, work);
        for &triangle in triangles {
            edges.add(triangle)?;
        }
        Ok(Self { triangles, next: 0, edges, symbols: Vec::new(), named: Vec::new(), last: 0 })
    }
}

impl Guide for Recorder<'_> {
    fn start(&mut self, found: &Edges<'_>) -> Result<[u32; 3], Damage> {
        let rest = &self.triangles[self.next..];
        let skip = rest.iter().position(|&[a, b, _]| found.corner(a, b).is_none());
        self.next += skip.ok_or(Damage::Invalid { what: "number of triangles" })?;
        let [a, b, c] = self.triangles[self.next];
        // Canonical order: each triangle starts with its smallest vertex, and they are sorted.
        for gap in [a - self.last, b - a - 1, c - a - 1] {
            put_varint(&mut self.named, u64::from(gap));
        }
        self.last = a;
        Ok([a, b, c])
    }

    fn corner(
        &mut self,
        [a, b]: [u32; 2],
        guess: &dyn Fn(&[u32]) -> Option<u32>,
    ) -> Result<Option<u32>, Damage> {
        let corner = self.edges.corner(a, b);
        let mut no = Vec::new();
        let Some(actual) = corner else {
            if guess(&no).is_some() {
                self.symbols.push(NONE);
            }
            return Ok(None);
        };
        for rank in 1..=GUESSES {
            match guess(&no) {
                Some(vertex) if vertex == actual => {
                    self.symbols.push(rank);
                    return Ok(corner);
                }
                Some(vertex) => no.push(vertex),
                None => break,
            }
        }
        self.symbols.push(NAMED);
        put_varint(&mut self.named, u64::from(actual));
        Ok(corner)
    }
}
