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

use std::collections::{BTreeSet, VecDeque};

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

/// Directed edges that have a triangle on their left.
///
/// The first few of each origin are in a list: most vertices have six, and the memory of a list is near where the
/// walk is (one hash table for all edges took 50 % longer). The others are in a tree, so that a vertex with a
/// thousand triangles is not slow.
#[derive(Debug)]
pub(crate) struct Edges<'w> {
    origins: Vec<Origin>,
    /// Next in the list of the same origin, target.
    listed: Vec<[u32; 2]>,
    /// Origin and target, of origins whose lists are full.
    more: BTreeSet<[u32; 2]>,
    work: &'w Work,
}

/// What is known of the edges of an origin.
#[derive(Debug, Clone, Copy)]
struct Origin {
    /// A bit for each target, by its number modulo 64: most edges that do not exist need no look at the list.
    targets: u64,
    first: u32,
    /// How long the list is.
    length: u32,
}

const END: u32 = u32::MAX;
/// A list has no more edges than this; a lookup in the tree also counts as this many steps.
const LIST_EDGES: u32 = 16;

impl<'w> Edges<'w> {
    /// No edges yet, of so many vertices and triangles. Looking at an edge counts as `work`.
    pub(crate) fn new(vertices: usize, triangles: usize, work: &'w Work) -> Self {
        // A section may claim more triangles than its vertices can have: at most two each.
        let triangles = triangles.min(2 * vertices);
        Self {
            origins: vec![Origin { targets: 0, first: END, length: 0 }; vertices],
            listed: Vec::with_capacity(3 * triangles),
            more: BTreeSet::new(),
            work,
        }
    }

    /// How many vertices edges may have.
    pub(crate) fn vertices(&self) -> usize {
        self.origins.len()
    }

    /// Whether a ► b has a triangle on its left.
    #[inline]
    pub(crate) fn has(&self, a: u32, b: u32) -> bool {
        let Origin { targets, first, length } = self.origins[a as usize];
        if targets >> (b % 64) & 1 == 0 {
            self.work.add(1);
            return false;
        }
        let mut at = first;
        let mut steps = 0;
        let mut found = false;
        while let Some(&[next, target]) = self.listed.get(at as usize) {
            steps += 1;
            if target == b {
                found = true;
                break;
            }
            at = next;
        }
        if !found && length == LIST_EDGES {
            steps += LIST_EDGES;
            found = self.more.contains(&[a, b]);
        }
        self.work.add(steps as usize);
        found
    }

    /// Whether neither b ► c nor c ► a has a triangle on its left.
    #[inline]
    fn allow(&self, [a, b, c]: [u32; 3]) -> bool {
        !self.has(b, c) && !self.has(c, a)
    }

    #[inline]
    fn add_edge(&mut self, a: u32, b: u32) {
        let origin = &mut self.origins[a as usize];
        origin.targets |= 1 << (b % 64);
        if origin.length == LIST_EDGES {
            self.more.insert([a, b]);
            return;
        }
        origin.length += 1;
        let next = std::mem::replace(&mut origin.first, self.listed.len() as u32);
        self.listed.push([next, b]);
    }

    /// Adds a triangle; an edge that has a triangle on that side already makes it fail.
    pub(crate) fn add(&mut self, [a, b, c]: [u32; 3]) -> Result<(), Damage> {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            if from == to || self.has(from, to) {
                return Err(Damage::Invalid("two triangles on the same side of an edge"));
            }
            self.add_edge(from, to);
        }
        Ok(())
    }

    /// Adds a triangle whose edges are known to have none on that side.
    #[inline]
    fn add_new(&mut self, [a, b, c]: [u32; 3]) {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            self.add_edge(from, to);
        }
    }
}

/// The guesses at a gate.
pub(crate) struct Guesses<'g, 'w> {
    /// `[a, b, d]`: the gate a ► b has the corner d on its right.
    pub(crate) gate: [u32; 3],
    pub(crate) nodes: &'g Nodes<'w>,
    edges: &'g Edges<'w>,
}

impl Guesses<'_, '_> {
    /// The best.
    #[inline]
    pub(crate) fn first(&self) -> Option<Corner> {
        let [a, b, _] = self.gate;
        self.nodes.best_corner([a, b], |c| self.edges.allow([a, b, c]))
    }

    /// The best of the vertices that are not among these.
    pub(crate) fn best_but(&self, no: &[u32]) -> Option<Corner> {
        let [a, b, _] = self.gate;
        self.nodes.best_corner([a, b], |c| !no.contains(&c) && self.edges.allow([a, b, c]))
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
    /// What is to the left of a gate.
    fn corner(&mut self, guesses: &Guesses<'_, '_>) -> Result<Answer, Damage>;
}

/// Walks until `count` triangles are found; gives them and the vertices in the order of the walk. Fails when that
/// takes more than the work allowed to `nodes`.
pub(crate) fn walk(
    nodes: &Nodes<'_>,
    count: usize,
    guide: &mut impl Guide,
) -> Result<(Vec<[u32; 3]>, Vec<Reached>), Damage> {
    let work = nodes.work();
    let mut edges = Edges::new(nodes.len(), count, work);
    let mut triangles = Vec::with_capacity(count);
    let mut order = Vec::with_capacity(nodes.len());
    let mut seen = vec![false; nodes.len()];
    let mut gates: VecDeque<[u32; 3]> = VecDeque::new();
    while triangles.len() < count {
        let (triangle, gate) = if let Some(gate) = gates.pop_front() {
            let [a, b, d] = gate;
            if edges.has(a, b) {
                continue;
            }
            let answer = guide.corner(&Guesses { gate, nodes, edges: &edges })?;
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
        if gate.is_none() {
            gates.push_back([b, a, c]);
        }
        gates.push_back([c, b, a]);
        gates.push_back([a, c, b]);
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
        Err(Damage::Invalid("a triangle's vertex"))
    }
}

#[cfg(test)]
#[path = "connectivity_tests.rs"]
mod tests;
