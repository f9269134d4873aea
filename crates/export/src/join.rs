//! The pieces of a way, put together again where tile borders cut them.

use std::collections::BTreeMap;

use crate::piece::{Piece, Vertex};

/// Heights of one place on a tile border come from the same two vertices in both tiles, each by its own triangle's plane:
/// they differ in their last bits. With coordinates below 2^24 m that is far less than this.
const SAME_HEIGHT_M: f64 = 1e-6;

/// A line without gaps: which pieces follow each other.
type Chain = Vec<usize>;

/// A line without gaps.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Line {
    pub(crate) vertices: Vec<Vertex>,
    /// Where pieces were joined: numbers of vertices, ascending.
    pub(crate) joins: Vec<usize>,
}

/// The lines of a way, from all its pieces.
pub(crate) fn lines(pieces: &[Piece]) -> Vec<Line> {
    chains(pieces).iter().map(|chain| line(pieces, chain)).collect()
}

/// The line of pieces that follow each other. The vertex where two meet is there once.
fn line(pieces: &[Piece], chain: &Chain) -> Line {
    let mut line = Line { vertices: Vec::new(), joins: Vec::new() };
    for &index in chain {
        let vertices = &pieces[index].vertices;
        if let Some(last) = line.vertices.len().checked_sub(1) {
            line.joins.push(last);
            line.vertices.extend(&vertices[1..]);
        } else {
            line.vertices.extend(vertices);
        }
    }
    line
}

/// Which pieces of a way follow each other: one list for each line without gaps, by the first of its pieces.
///
/// ```text
///   tile A        │ tile B        │ tile C            ●  a point on the border: the same lattice point in both tiles
///   o──────o──────●───o────── ────●──o──────o         a gap in B: no ground. Two lines: [A 0, B 0] and [B 1, C 0]
///        A 0      │  B 0      B 1 │    C 0
/// ```
///
/// A piece that ends at a place goes on with one that begins there, of another tile if there is one, else the first in the
/// package's order. More than one can only begin there where the way meets itself exactly on a border.
fn chains(pieces: &[Piece]) -> Vec<Chain> {
    let mut starts: BTreeMap<[u64; 2], Vec<usize>> = BTreeMap::new();
    for (index, piece) in pieces.iter().enumerate() {
        if let (true, Some(first)) = (piece.goes_on[0], piece.vertices.first()) {
            starts.entry(first.at.map(f64::to_bits)).or_default().push(index);
        }
    }
    let mut next: Vec<Option<usize>> = vec![None; pieces.len()];
    let mut follows = vec![false; pieces.len()];
    for (index, piece) in pieces.iter().enumerate() {
        let (true, Some(last)) = (piece.goes_on[1], piece.vertices.last()) else { continue };
        let Some(candidates) = starts.get(&last.at.map(f64::to_bits)) else { continue };
        let fits = |&&other: &&usize| {
            let first = pieces[other].vertices.first();
            let is_level = first.is_some_and(|first| (first.z_m - last.z_m).abs() <= SAME_HEIGHT_M);
            other != index && !follows[other] && is_level
        };
        let is_elsewhere = |&&other: &&usize| pieces[other].key.tile != piece.key.tile;
        let of_another_tile = candidates.iter().filter(fits).find(is_elsewhere);
        next[index] = of_another_tile.or_else(|| candidates.iter().find(fits)).copied();
        if let Some(other) = next[index] {
            follows[other] = true;
        }
    }
    let mut chains = Vec::new();
    let mut is_taken = vec![false; pieces.len()];
    // Lines with a beginning first; what is left are rings, which begin with their first piece.
    let beginnings = (0..pieces.len()).filter(|&index| !follows[index]);
    for beginning in beginnings.chain(0..pieces.len()) {
        let mut chain = Chain::new();
        let mut at = Some(beginning);
        while let Some(index) = at.filter(|&index| !is_taken[index]) {
            is_taken[index] = true;
            chain.push(index);
            at = next[index];
        }
        if !chain.is_empty() {
            chains.push(chain);
        }
    }
    chains.sort_unstable();
    chains
}

#[cfg(test)]
#[path = "join_tests.rs"]
mod tests;
