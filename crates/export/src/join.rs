//! Joins the pieces of a way where tile borders cut them.

use std::collections::BTreeMap;

use crate::piece::{Vertex, WayPiece};

/// Heights of one place on a tile border are interpolated between the same two vertices in both
/// tiles, each in its own triangle's plane: they differ in their last bits. With coordinates below
/// 2^24 m, the difference is far below this.
const SAME_HEIGHT_M: f64 = 1e-6;

/// A line without gaps.
#[derive(Debug, Clone)]
pub(crate) struct JoinedLine {
    pub(crate) vertices: Vec<Vertex>,
    /// The numbers of the vertices at which pieces were joined, ascending.
    pub(crate) joins: Vec<usize>,
}

/// Returns the lines of a way, from all its pieces.
pub(crate) fn lines(pieces: &[WayPiece]) -> Vec<JoinedLine> {
    chains(pieces).iter().map(|chain| line(pieces, chain)).collect()
}

/// Returns the line of consecutive pieces. The vertex between two pieces occurs once.
fn line(pieces: &[WayPiece], chain: &[usize]) -> JoinedLine {
    let mut line = JoinedLine { vertices: Vec::new(), joins: Vec::new() };
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

/// Returns the pieces of a way in order: one list for each line without gaps, sorted by the first
/// of its pieces.
///
/// ```text
///   tile A        │ tile B        │ tile C            ●  a point on the border: the same lattice point in both tiles
///   o──────o──────●───o────── ────●──o──────o         a gap in B: no ground. Two lines: [A 0, B 0] and [B 1, C 0]
///        A 0      │  B 0      B 1 │    C 0
/// ```
///
/// A piece that ends at a place is continued by one that begins there: one of another tile if
/// possible, otherwise the first in the package's order. There is more than one only if the way
/// meets itself exactly on a border.
fn chains(pieces: &[WayPiece]) -> Vec<Vec<usize>> {
    let mut starts: BTreeMap<[u64; 2], Vec<usize>> = BTreeMap::new();
    for (index, piece) in pieces.iter().enumerate() {
        if let (true, Some(first)) = (piece.goes_on[0], piece.vertices.first()) {
            starts.entry(first.at.map(f64::to_bits)).or_default().push(index);
        }
    }
    let mut following = Following::among(pieces.len());
    for (index, piece) in pieces.iter().enumerate() {
        let (true, Some(last)) = (piece.goes_on[1], piece.vertices.last()) else { continue };
        let Some(candidates) = starts.get(&last.at.map(f64::to_bits)) else { continue };
        let fits = |&&other: &&usize| {
            let first = pieces[other].vertices.first();
            let is_level = first.is_some_and(|first| (first.z_m - last.z_m).abs() <= SAME_HEIGHT_M);
            other != index && !following.has_before[other] && is_level
        };
        let is_elsewhere = |&&other: &&usize| pieces[other].key.tile != piece.key.tile;
        let of_another_tile = candidates.iter().filter(fits).find(is_elsewhere);
        if let Some(&other) = of_another_tile.or_else(|| candidates.iter().find(fits)) {
            following.join(index, other);
        }
    }
    let mut chains = following.chains(0..pieces.len());
    chains.sort_unstable();
    chains
}

/// A successor for each of some numbers.
pub(crate) struct Following {
    pub(crate) next: Vec<Option<usize>>,
    pub(crate) has_before: Vec<bool>,
}

impl Following {
    /// Returns numbers below `count` without successors.
    pub(crate) fn among(count: usize) -> Self {
        Self { next: vec![None; count], has_before: vec![false; count] }
    }

    /// Makes one number the successor of another; it must not be a successor yet.
    pub(crate) fn join(&mut self, one: usize, other: usize) {
        self.next[one] = Some(other);
        self.has_before[other] = true;
    }

    /// Returns the chains of successors: first those with a beginning, then the rings, which begin
    /// with the first of `numbers`.
    pub(crate) fn chains(self, numbers: impl Iterator<Item = usize> + Clone) -> Vec<Vec<usize>> {
        let Self { next, has_before } = self;
        let mut is_taken = vec![false; next.len()];
        let mut chains = Vec::new();
        let beginnings = numbers.clone().filter(|&number| !has_before[number]);
        for beginning in beginnings.chain(numbers) {
            let mut chain = Vec::new();
            let mut at = Some(beginning);
            while let Some(number) = at.filter(|&number| !is_taken[number]) {
                is_taken[number] = true;
                chain.push(number);
                at = next[number];
            }
            if !chain.is_empty() {
                chains.push(chain);
            }
        }
        chains
    }
}

#[cfg(test)]
#[path = "join_tests.rs"]
mod tests;
