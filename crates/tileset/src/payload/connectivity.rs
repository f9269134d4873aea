//! Finds the triangles of the vertices. Writer and reader make the same guesses; only wrong guesses
//! cost bits.
//!
//! The triangles of a TIN are nearly a Delaunay triangulation of its vertices, so a reader that
//! knows the vertices can guess them. Writer and reader walk over the triangles in the same order,
//! from edge to edge:
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
//! The guesses are computed in exact integer arithmetic. Computing the Delaunay triangulation
//! itself would not be enough: nodes of a grid are often on one circle, and boundaries are
//! constrained edges.
//!
//! Source for the walk: Touma & Gotsman 1998, *Triangle Mesh Compression*, and for guessing
//! connectivity from positions: Lewiner, Lopes, Mello & Velho 2005, *`GEncode`: Geometry-driven
//! compression for general meshes*. What we changed: all positions come first, sorted, which is
//! cheaper than positions in walking order.

use std::collections::{BTreeSet, VecDeque};

use crate::payload::{
    corner_guess::{GateCorner, GridVertices},
    damage::{Damage, Result},
    work_limit::StepBudget,
};

/// There is no triangle to the left of the gate.
pub(crate) const NONE: u8 = 0;
/// Guesses 1 … 6 have their own symbols.
pub(crate) const GUESSES: u8 = 6;
/// The vertex is given as a named number.
pub(crate) const NAMED: u8 = GUESSES + 1;

/// A vertex, and the gate through which the walk reached it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Reached {
    pub vertex: u32,
    /// The vertices `[a, b, d]` of the gate; three times the vertex itself where a walk starts.
    pub gate: [u32; 3],
}

/// Directed edges that have a triangle on their left.
///
/// The first few edges of each origin are in a list: most vertices have six, and the lists of
/// neighbours are close together in memory (one hash table for all edges took 50 % longer). The
/// other edges are in a tree, so that a vertex with a thousand triangles is not slow.
#[derive(Debug)]
pub(crate) struct Edges<'w> {
    origins: Vec<Origin>,
    /// Next index in the list of the same origin, and target.
    listed: Vec<[u32; 2]>,
    /// Origin and target of the edges of origins whose lists are full.
    more: BTreeSet<[u32; 2]>,
    work: &'w StepBudget,
}

/// The edges of an origin.
#[derive(Debug, Clone, Copy)]
struct Origin {
    /// A bit for each target, by its number modulo 64: for most edges that do not exist, the list
    /// need not be searched.
    targets: u64,
    first: u32,
    /// Length of the list.
    length: u32,
}

const END: u32 = u32::MAX;
/// The largest length of a list; a lookup in the tree also counts as this many steps.
const LIST_EDGES: u32 = 16;

impl<'w> Edges<'w> {
    /// Creates a structure without edges for this many vertices and triangles. Each examined edge
    /// counts as `work`.
    pub(crate) fn new(vertices: usize, triangles: usize, work: &'w StepBudget) -> Self {
        // A section may claim more triangles than its vertices can have: at most two for each
        // vertex.
        let triangles = triangles.min(2 * vertices);
        Self {
            origins: vec![Origin { targets: 0, first: END, length: 0 }; vertices],
            listed: Vec::with_capacity(3 * triangles),
            more: BTreeSet::new(),
            work,
        }
    }

    /// The number of vertices.
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

    /// Adds a triangle; fails if an edge already has a triangle on this side.
    pub(crate) fn add(&mut self, [a, b, c]: [u32; 3]) -> Result<()> {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            Damage::invalid_if(
                from == to || self.has(from, to),
                "two triangles on the same side of an edge",
            )?;
            self.add_edge(from, to);
        }
        Ok(())
    }

    /// Adds a triangle whose edges are known to have no triangle on this side.
    #[inline]
    fn add_new(&mut self, [a, b, c]: [u32; 3]) {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            self.add_edge(from, to);
        }
    }
}

/// The guesses at a gate.
pub(crate) struct Guesses<'g, 'w> {
    /// The vertices `[a, b, d]`: the gate a ► b has the corner d on its right.
    pub gate: [u32; 3],
    pub nodes: &'g GridVertices<'w>,
    edges: &'g Edges<'w>,
}

impl Guesses<'_, '_> {
    /// The best guess.
    #[inline]
    pub(crate) fn first(&self) -> Option<GateCorner> {
        let [a, b, _] = self.gate;
        self.nodes.best_corner([a, b], |c| self.edges.allow([a, b, c]))
    }

    /// The best of the vertices that are not in `no`.
    pub(crate) fn best_but(&self, no: &[u32]) -> Option<GateCorner> {
        let [a, b, _] = self.gate;
        self.nodes.best_corner([a, b], |c| !no.contains(&c) && self.edges.allow([a, b, c]))
    }
}

/// The answer at a gate: what is to its left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum GateAnswer {
    /// No triangle.
    Nothing,
    /// A guessed vertex, whose edges to the gate have no triangle yet.
    Guessed(u32),
    /// Any vertex.
    Named(u32),
}

/// Decides which triangles the walk finds: when writing from the triangles themselves, when reading
/// from the symbols.
pub(crate) trait Guide {
    /// A triangle to start from that has not been found yet.
    fn start(&mut self, found: &Edges<'_>) -> Result<[u32; 3]>;
    /// The answer at a gate.
    fn corner(&mut self, guesses: &Guesses<'_, '_>) -> Result<GateAnswer>;
}

/// Walks until `count` triangles are found; returns them, and the vertices in the order of the
/// walk. Fails if the walk takes more work than the budget of `nodes` allows.
pub(crate) fn walk(
    nodes: &GridVertices<'_>,
    count: usize,
    guide: &mut impl Guide,
) -> Result<(Vec<[u32; 3]>, Vec<Reached>)> {
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
            let (GateAnswer::Guessed(c) | GateAnswer::Named(c)) = answer else { continue };
            if let GateAnswer::Guessed(_) = answer {
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

fn check_vertex(vertex: u32, nodes: &GridVertices<'_>) -> Result<()> {
    if (vertex as usize) < nodes.len() {
        Ok(())
    } else {
        Err(Damage::Invalid("a triangle's vertex"))
    }
}

#[cfg(test)]
#[path = "connectivity_tests.rs"]
mod tests;
