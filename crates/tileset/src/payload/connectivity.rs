//! Which vertices make triangles. Both sides guess; only wrong guesses cost bits.
//!
//! The triangles of a TIN are nearly a Delaunay triangulation of its vertices, so a reader that knows the
//! vertices can guess them. Writer and reader walk over the triangles in the same order, from edge to edge:
//!
//! ```text
//!            c?                 a gate a ► b: the triangle below it, with corner d, is known;
//!           . .                 which vertex c makes the triangle above it?
//!          .   .
//!        a ─────► b             guess: the c to the left of a ► b that sees it under the largest angle
//!          \   /                (no vertex lies in the circle through a, b, c above the gate);
//!           \ /                 a symbol says "yes", "the next best", … or "no triangle"
//!            d
//! ```
//!
//! The guesses are exact integer arithmetic. To compute the Delaunay triangulation itself would not be enough: nodes
//! of a grid often lie on one circle, and boundaries are constrained edges.
//!
//! Source for the walk: Touma & Gotsman 1998, *Triangle Mesh Compression*, and for guessing connectivity from
//! positions: Lewiner, Lopes, Mello & Velho 2005, *`GEncode`: Geometry-driven compression for general meshes*.
//! What we changed: all positions come first, sorted, which is cheaper than positions in walking order.

use std::collections::{BTreeMap, VecDeque};

use crate::payload::corner_guess::{Corner, Nodes};
use crate::payload::damage::Damage;
use crate::payload::work_limit::Work;

/// There is no triangle on the left of the gate.
pub(crate) const NONE: u8 = 0;
/// Guesses 1 … 6 have their own symbols.
pub(crate) const GUESSES: u8 = 6;
/// The vertex is named.
pub(crate) const NAMED: u8 = GUESSES + 1;

/// A vertex, and what was known when the walk came to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Reached {
    pub(crate) vertex: u32,
    /// `[a, b, d]` of the gate; the vertex itself three times where a walk starts.
    pub(crate) gate: [u32; 3],
}

/// Directed edges with the corner to their left.
///
/// The first few of each origin are in a list: most vertices have six, and the memory of a list is near where the
/// walk is (one hash table for all edges took 50 % longer). The others are in a tree, so that a vertex with a
/// thousand triangles is not slow.
#[derive(Debug)]
pub(crate) struct Edges<'w> {
    first: Vec<u32>,
    /// How long each list is.
    lengths: Vec<u8>,
    /// Next in the list of the same origin, target, corner.
    listed: Vec<[u32; 3]>,
    /// Corners by origin and target, of origins whose lists are full.
    more: BTreeMap<[u32; 2], u32>,
    work: &'w Work,
}

const END: u32 = u32::MAX;
/// A list has no more edges than this; a lookup in the tree also counts as this many steps.
const LIST_EDGES: u8 = 16;

impl<'w> Edges<'w> {
    /// Looking at an edge counts as `work`.
    pub(crate) fn new(vertices: usize, work: &'w Work) -> Self {
        Self {
            first: vec![END; vertices],
            lengths: vec![0; vertices],
            listed: Vec::new(),
            more: BTreeMap::new(),
            work,
        }
    }

    /// How many vertices edges may have.
    pub(crate) fn vertices(&self) -> usize {
        self.first.len()
    }

    pub(crate) fn corner(&self, a: u32, b: u32) -> Option<u32> {
        let mut at = self.first[a as usize];
        let mut steps = 0;
        let mut found = None;
        while let Some(&[next, target, corner]) = self.listed.get(at as usize) {
            steps += 1;
            if target == b {
                found = Some(corner);
                break;
            }
            at = next;
        }
        if found.is_none() && steps == usize::from(LIST_EDGES) {
            steps += usize::from(LIST_EDGES);
            found = self.more.get(&[a, b]).copied();
        }
        self.work.add(steps);
        found
    }

    /// Whether neither b ► c nor c ► a has a triangle on its left.
    fn allow(&self, [a, b, c]: [u32; 3]) -> bool {
        // A vertex without edges has no triangle.
        if self.lengths[c as usize] == 0 {
            self.work.add(1);
            return true;
        }
        self.corner(b, c).is_none() && self.corner(c, a).is_none()
    }

    fn add_edge(&mut self, a: u32, b: u32, corner: u32) {
        let length = &mut self.lengths[a as usize];
        if *length == LIST_EDGES {
            self.more.insert([a, b], corner);
            return;
        }
        *length += 1;
        let at = self.listed.len() as u32;
        self.listed.push([self.first[a as usize], b, corner]);
        self.first[a as usize] = at;
    }

    /// Adds a triangle; an edge that has a triangle on that side already makes it fail.
    pub(crate) fn add(&mut self, [a, b, c]: [u32; 3]) -> Result<(), Damage> {
        for [from, to, corner] in [[a, b, c], [b, c, a], [c, a, b]] {
            if from == to || self.corner(from, to).is_some() {
                return Err(Damage::Invalid { what: "two triangles on the same side of an edge" });
            }
            self.add_edge(from, to, corner);
        }
        Ok(())
    }

    /// Adds a triangle whose edges are known to have none on that side.
    fn add_new(&mut self, [a, b, c]: [u32; 3]) {
        for [from, to, corner] in [[a, b, c], [b, c, a], [c, a, b]] {
            self.add_edge(from, to, corner);
        }
    }
}

/// What is to the left of a gate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Answer {
    /// No triangle.
    Nothing,
    /// A vertex that was guessed, so its edges to the gate have no triangle yet.
    Guessed(u32),
    /// Any vertex.
    Named(u32),
}

/// What decides which triangles the walk finds: the triangles themselves when writing, the symbols when reading.
pub(crate) trait Guide {
    /// A triangle to start from, not found yet.
    fn start(&mut self, found: &Edges<'_>) -> Result<[u32; 3], Damage>;
    /// What is to the left of the gate a ► b with the corner d on its right. `guess` takes the vertices that are no answer and gives the
    /// next best one.
    fn corner(
        &mut self,
        gate: [u32; 3],
        nodes: &Nodes<'_>,
        guess: &dyn Fn(&[u32]) -> Option<Corner>,
    ) -> Result<Answer, Damage>;
}

/// Walks until `count` triangles are found; gives them and the vertices in the order of the walk. Fails when that
/// takes more than the work allowed to `nodes`.
pub(crate) fn walk(
    nodes: &Nodes<'_>,
    count: usize,
    guide: &mut impl Guide,
) -> Result<(Vec<[u32; 3]>, Vec<Reached>), Damage> {
    let work = nodes.work();
    let mut edges = Edges::new(nodes.len(), work);
    let mut triangles = Vec::with_capacity(count);
    let mut order = Vec::with_capacity(nodes.len());
    let mut seen = vec![false; nodes.len()];
    let mut gates: VecDeque<[u32; 3]> = VecDeque::new();
    while triangles.len() < count {
        let (triangle, gate) = if let Some([a, b, d]) = gates.pop_front() {
            if edges.corner(a, b).is_some() {
                continue;
            }
            let guess = |no: &[u32]| {
                nodes.best_corner([a, b], |c| !no.contains(&c) && edges.allow([a, b, c]))
            };
            let answer = guide.corner([a, b, d], nodes, &guess)?;
            work.check()?;
            let (Answer::Guessed(c) | Answer::Named(c)) = answer else { continue };
            if let Answer::Guessed(_) = answer {
                edges.add_new([a, b, c]);
            } else {
                check_vertex(c, nodes)?;
                edges.add([a, b, c])?;
            }
            ([a, b, c], Some([a, b, d]))
        } else {
            let start = guide.start(&edges)?;
            work.check()?;
            start.iter().try_for_each(|&vertex| check_vertex(vertex, nodes))?;
            edges.add(start)?;
            (start, None)
        };
        triangles.push(triangle);
        for vertex in triangle {
            if !std::mem::replace(&mut seen[vertex as usize], true) {
                order.push(Reached { vertex, gate: gate.unwrap_or([vertex; 3]) });
            }
        }
        let [a, b, c] = triangle;
        let sides: &[[u32; 3]] = if gate.is_some() {
            &[[c, b, a], [a, c, b]]
        } else {
            &[[b, a, c], [c, b, a], [a, c, b]]
        };
        gates.extend(sides);
    }
    // Vertices that belong to no triangle come last.
    let rest = (0..nodes.len() as u32).filter(|&vertex| !seen[vertex as usize]);
    order.extend(rest.map(|vertex| Reached { vertex, gate: [vertex; 3] }));
    Ok((triangles, order))
}

fn check_vertex(vertex: u32, nodes: &Nodes<'_>) -> Result<(), Damage> {
    if (vertex as usize) < nodes.len() {
        Ok(())
    } else {
        Err(Damage::Invalid { what: "a triangle's vertex" })
    }
}

#[cfg(test)]
#[path = "connectivity_tests.rs"]
mod tests;
