//! The TERRAIN section: vertices, triangles, heights, normals.

use corniche_geom::{Cell, TILE_NODES};
use corniche_tin::{Tin, TinVertex};
use serde::{Deserialize, Serialize};

use super::{
    Damage, Terrain,
    codec::{Cursor, unzigzag},
    connectivity::{Edges, GUESSES, Guide, NAMED, NONE, Reached, walk},
    nodes::Nodes,
    work::Work,
};
use crate::{
    limits::{MAX_TRIANGLES, MAX_VERTICES, max_walk_steps},
    manifest::MAX_MEASURE_M,
};

/// Bytes of a [`Record`] in bincode's legacy layout.
const RECORD_BYTES: usize = 49;

/// The fixed part of the section, in `bincode`'s legacy layout: fields in order, little-endian, fixed width.
#[derive(Serialize, Deserialize)]
struct Record {
    geometric_error_m: f64,
    height_range_m: [f64; 2],
    uncovered_nodes: u64,
    vertices: u32,
    triangles: u32,
    /// Bytes of the walk's symbols.
    symbols: u32,
    /// Bytes of the vertices that the walk names.
    named: u32,
    /// All heights are multiples of 2^this steps: a DEM in whole metres has no finer ones.
    height_shift: u8,
}

/// What turns slopes of the TIN, in height steps per node, into metres per metre.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scale {
    pub(crate) quantum_m: f64,
    /// The level's.
    pub(crate) cell: Cell,
    /// No more full-resolution nodes than this lie beneath the tile, border nodes of its finest tiles counted for each.
    pub(crate) nodes_beneath: u64,
}

pub(crate) fn decode(bytes: &[u8], scale: Scale) -> Result<Terrain, Damage> {
    let mut cursor = Cursor::new(bytes);
    let config = bincode::config::legacy().with_limit::<RECORD_BYTES>();
    let (record, _): (Record, usize) =
        bincode::serde::decode_from_slice(cursor.take(RECORD_BYTES)?, config)
            .map_err(|_| Damage::Invalid { what: "the record of the section" })?;
    check_measures(record.geometric_error_m, record.height_range_m, record.uncovered_nodes, scale)
        .map_err(|what| Damage::Invalid { what })?;
    let count = at_most(record.vertices, MAX_VERTICES, "number of vertices")?;
    let triangle_count = at_most(record.triangles, MAX_TRIANGLES, "number of triangles")?;
    let at = decode_nodes(&mut cursor, count)?;
    let work = Work::new(max_walk_steps(count, triangle_count));
    let nodes = Nodes::new(at.iter().copied(), &work);
    let mut player = Player {
        symbols: Cursor::new(cursor.take(record.symbols as usize)?),
        named: Cursor::new(cursor.take(record.named as usize)?),
        last: 0,
    };
    let (triangles, order) = walk(&nodes, triangle_count, &mut player)?;
    player.symbols.finish()?;
    player.named.finish()?;
    let residuals = cursor.planes(count)?;
    if record.height_shift >= 32 {
        return Err(Damage::Invalid { what: "the common factor of the heights" });
    }
    // In units of 2^height_shift steps.
    let mut heights = vec![0_i32; count];
    let mut previous = 0;
    for (reached, residual) in order.iter().zip(residuals.iter()) {
        let guess = guess_height(reached, &heights, previous);
        previous = guess.wrapping_add(unzigzag(residual) as i32);
        heights[reached.vertex as usize] = previous;
    }
    let vertices: Vec<TinVertex> = at
        .iter()
        .zip(&heights)
        .map(|(&[column, row], &height)| TinVertex {
            row,
            column,
            height_q: height << record.height_shift,
        })
        .collect();
    let normals = guess_normals(&vertices, &triangles, scale);
    let tin = Tin::new(vertices, &triangles)?;
    let (east, north) = (cursor.take(count)?, cursor.take(count)?);
    cursor.finish()?;
    let normals = normals
        .iter()
        .zip(east.iter().zip(north))
        .map(|(guess, (&e, &n))| [guess[0].wrapping_add(e as i8), guess[1].wrapping_add(n as i8)])
        .collect();
    Ok(Terrain {
        tin,
        normals,
        geometric_error_m: record.geometric_error_m,
        height_range_m: record.height_range_m,
        uncovered_nodes: record.uncovered_nodes,
    })
}

/// What a tile says of itself: finite, so that nothing later has to ask, and no more than can be true.
fn check_measures(
    geometric_error_m: f64,
    height_range_m: [f64; 2],
    uncovered_nodes: u64,
    scale: Scale,
) -> Result<(), &'static str> {
    if !(0.0..=MAX_MEASURE_M).contains(&geometric_error_m) {
        return Err("the geometric error");
    }
    let [low, high] = height_range_m;
    if !(low <= high && low >= -MAX_MEASURE_M && high <= MAX_MEASURE_M) {
        return Err("the height range");
    }
    if uncovered_nodes > scale.nodes_beneath {
        return Err("the number of uncovered nodes");
    }
    Ok(())
}

fn at_most(count: u32, limit: usize, what: &'static str) -> Result<usize, Damage> {
    let count = count as usize;
    if count > limit {
        return Err(Damage::TooLarge { what, length: count as u64, limit: limit as u64 });
    }
    Ok(count)
}

/// Columns and rows: how many vertices each row has, then the gaps between their columns.
fn decode_nodes(cursor: &mut Cursor<'_>, count: usize) -> Result<Vec<[u16; 2]>, Damage> {
    let what = "positions of the vertices";
    let mut per_row = [0; TILE_NODES];
    for row in &mut per_row {
        *row = cursor.bounded(TILE_NODES, what)?;
    }
    if per_row.iter().sum::<usize>() != count {
        return Err(Damage::Invalid { what });
    }
    let mut at = Vec::with_capacity(count);
    for (row, &in_row) in per_row.iter().enumerate() {
        let mut next = 0;
        for _ in 0..in_row {
            let column = next + cursor.bounded(TILE_NODES, what)?;
            if column >= TILE_NODES {
                return Err(Damage::Invalid { what });
            }
            at.push([column as u16, row as u16]);
            next = column + 1;
        }
    }
    Ok(at)
}

/// Finds triangles by reading symbols.
struct Player<'a> {
    symbols: Cursor<'a>,
    named: Cursor<'a>,
    /// First vertex of the last start.
    last: u32,
}

impl Player<'_> {
    fn vertex(&mut self) -> Result<u32, Damage> {
        self.named.bounded(MAX_VERTICES, "a named vertex").map(|vertex| vertex as u32)
    }
}

impl Guide for Player<'_> {
    fn start(&mut self, _: &Edges<'_>) -> Result<[u32; 3], Damage> {
        let a = self.last + self.vertex()?;
        self.last = a;
        // Each corner is above the first, which is the smallest; the sum of two bounded numbers is in range.
        Ok([a, a + 1 + self.vertex()?, a + 1 + self.vertex()?])
    }

    fn corner(
        &mut self,
        _: [u32; 2],
        guess: &dyn Fn(&[u32]) -> Option<u32>,
    ) -> Result<Option<u32>, Damage> {
        let Some(first) = guess(&[]) else { return Ok(None) };
        match self.symbols.byte()? {
            NONE => Ok(None),
            1 => Ok(Some(first)),
            rank @ 2..=GUESSES => {
                let mut no = vec![first];
                loop {
                    let next = guess(&no)
                        .ok_or(Damage::Invalid { what: "a guess that does not exist" })?;
                    no.push(next);
                    if no.len() == usize::from(rank) {
                        return Ok(Some(next));
                    }
                }
            }
            NAMED => self.vertex().map(Some),
            _ => Err(Damage::Invalid { what: "a symbol of the walk" }),
        }
    }
}

/// The height to expect at a vertex, from those that the walk met before.
///
/// Halfway between the middle of the gate and the parallelogram over the triangle below it, which alone overshoots
/// on rough ground. (Weighting all neighbours by distance saves 3 to 5 % more of the heights, at the price of
/// arithmetic that is hard to specify to the bit.)
fn guess_height(reached: &Reached, heights: &[i32], previous: i32) -> i32 {
    let Reached { vertex, gate } = *reached;
    if gate == [vertex; 3] {
        return previous;
    }
    let [a, b, d] = gate.map(|vertex| i64::from(heights[vertex as usize]));
    // (3a + 3b − 2d) / 4, rounded down.
    (3 * (a + b) - 2 * d).div_euclid(4).clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32
}

/// The normals to expect: of the triangles around each vertex, weighted by their areas, octahedron-coded.
///
/// An upward normal (x, y, z) is (x, y) / (|x| + |y| + z) on the octahedron: no root, so every machine
/// computes the same bits.
fn guess_normals(vertices: &[TinVertex], triangles: &[[u32; 3]], scale: Scale) -> Vec<[i8; 2]> {
    let mut sums = vec![[0_i64; 3]; vertices.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|vertex| {
            let TinVertex { row, column, height_q } = vertices[vertex as usize];
            [i64::from(column), -i64::from(row), i64::from(height_q)]
        });
        let edge = |p: [i64; 3]| [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
        let (p, q) = (edge(b), edge(c));
        let normal =
            [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
        for &vertex in triangle {
            for (sum, part) in sums[vertex as usize].iter_mut().zip(normal) {
                *sum += part;
            }
        }
    }
    let steepness = scale.cell.to_array().map(|side_m| scale.quantum_m / side_m);
    sums.iter()
        .map(|&[x, y, z]| {
            let (x, y, z) = (x as f64 * steepness[0], y as f64 * steepness[1], z as f64);
            let length = x.abs() + y.abs() + z;
            // `as` turns the not-a-number of a vertex without triangles into 0.
            [x, y].map(|value| (value / length * 127.0).round() as i8)
        })
        .collect()
}

#[cfg(test)]
pub(crate) use write::Recorder;
#[cfg(feature = "write")]
pub(crate) use write::encode;

#[cfg(feature = "write")]
mod write {
    use super::{
        Damage, Edges, GUESSES, Guide, MAX_TRIANGLES, MAX_VERTICES, NAMED, NONE, Nodes, Record,
        Scale, TILE_NODES, Terrain, Work, check_measures, guess_height, guess_normals,
        max_walk_steps, walk,
    };
    use crate::payload::codec::{put_planes, put_varint, zigzag};

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
        // The same limit as a reader's: the writer looks at no less than the reader will.
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
        let mut heights = vec![0; vertices.len()];
        let mut previous = 0;
        let residuals: Vec<u64> = order
            .iter()
            .map(|reached| {
                let guess = guess_height(reached, &heights, previous);
                previous = vertices[reached.vertex as usize].height_q >> height_shift;
                heights[reached.vertex as usize] = previous;
                zigzag(i64::from(previous.wrapping_sub(guess)))
            })
            .collect();
        put_planes(&mut out, &residuals);
        let guesses = guess_normals(vertices, &found, scale);
        for axis in 0..2 {
            let residual = |(normal, guess): (&[i8; 2], &[i8; 2])| {
                normal[axis].wrapping_sub(guess[axis]) as u8
            };
            out.extend(terrain.normals.iter().zip(&guesses).map(residual));
        }
        Ok(out)
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
}
