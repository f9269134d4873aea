//! Finds the spans of a network, and where they are carried.

use std::collections::BTreeMap;

use corniche_geom::{IndexLists, LatticePoint};
use corniche_network::{ChainNumber, Chains, Network, NodeNumber};

use crate::{
    Distance,
    crossing_place::steepest_of,
    spans::{Joint, SpanEdge, SpanKind, Spans, Support},
};

/// The length, in metres, at a chain's end that gives the direction in which the chain leaves its
/// node.
const DIRECTION_M: f64 = 10.0;
/// The maximum number of ends at a node that are compared with each other; no real node has as
/// many.
const MOST_ENDS: usize = 64;

impl Spans {
    /// Returns the spans of a network. `chains` are the chains of
    /// [`corniche_network::Breaks::JunctionsAndStructures`], so the splitting of ways does not
    /// matter.
    ///
    /// A joint is a support where the span ends and something else continues. Where the span passes
    /// through, a way on the ground that touches it, such as steps, carries nothing:
    ///
    /// ```text
    ///    ═══════●─── ground        ═══●═══        ═════╗                        │
    ///    a support                    │ steps          ●─── ground      ═══════●═══════  a street between two bridges:
    ///                                 free        ═════╝  a support            │         a support
    /// ```
    ///
    /// Only a span that nothing else carries, such as a roundabout on a bridge, is carried by the
    /// roads that touch it.
    #[must_use]
    pub fn find(network: &Network, chains: &Chains, distance_m: &Distance<'_>) -> Self {
        let mut finder = Finder { network, chains, distance_m, numbers: BTreeMap::new() };
        let mut joints: Vec<Joint> = Vec::new();
        let mut edges: Vec<SpanEdge> = Vec::new();
        for chain in chains.numbers() {
            let found = chains.get(chain);
            let Some(kind) = SpanKind::from_structure(network.structure_of(&found)) else {
                continue;
            };
            let points = network.points_of_chain(&found);
            let ends = [points.first(), points.last()].map(Option::<&LatticePoint>::copied);
            let [Some(first), Some(last)] = ends else { continue };
            let pairs = points.array_windows();
            let length_m = pairs.map(|[a, b]| distance_m(a.in_steps(), b.in_steps())).sum();
            let [from, to] = found.ends;
            let own = [(from, first), (to, last)]
                .map(|(node, at)| finder.joint(kind, node, at, &mut joints));
            let ways = || found.links.iter().map(|&link| network.way_of(link));
            let way_id = ways().map(|way| way.way_id).min().unwrap_or_default();
            let steepest = ways().map(|way| steepest_of(network, way)).fold(0.0, f64::max);
            edges.push(SpanEdge { chain, kind, span: 0, joints: own, length_m, way_id, steepest });
        }
        let edges_at = IndexLists::new(joints.len(), 2 * edges.len(), |end| {
            std::iter::once(edges[end / 2].joints[end % 2] as usize)
        });
        let count = number_spans(&mut edges, &edges_at);
        let ends_at = chains.ends_at(network, |_| true);
        for (number, joint) in joints.iter_mut().enumerate() {
            let Some(&first) = edges_at.list(number).first() else { continue };
            let kind = edges[first as usize / 2].kind;
            finder.support(kind, ends_at.list(network.index_of(joint.node)), joint);
        }
        let span_of =
            |number: usize| Some(edges[*edges_at.list(number).first()? as usize / 2].span);
        let mut is_carried = vec![false; count];
        for (number, joint) in joints.iter().enumerate() {
            if let Some(span) = span_of(number) {
                is_carried[span as usize] |= joint.support.is_some();
            }
        }
        for (number, joint) in joints.iter_mut().enumerate() {
            let is_free = span_of(number).is_some_and(|span| !is_carried[span as usize]);
            if is_free && joint.is_touched {
                joint.support = Some(Support::Touching);
            }
        }
        Self { edges, joints, edges_at, count }
    }
}

struct Finder<'a> {
    network: &'a Network,
    chains: &'a Chains,
    distance_m: &'a Distance<'a>,
    numbers: BTreeMap<(SpanKind, NodeNumber), u32>,
}

impl Finder<'_> {
    fn joint(
        &mut self,
        kind: SpanKind,
        node: NodeNumber,
        at: LatticePoint,
        joints: &mut Vec<Joint>,
    ) -> u32 {
        *self.numbers.entry((kind, node)).or_insert_with(|| {
            let node_id = self.network.node_id(node);
            let [is_passed, is_touched] = [false; 2];
            joints.push(Joint { node, node_id, at, support: None, is_passed, is_touched });
            joints.len() as u32 - 1
        })
    }

    /// Finds out how a joint of a kind carries its span; `ends` are all chain ends at its node.
    fn support(&self, kind: SpanKind, ends: &[u32], joint: &mut Joint) {
        let kind_of = |end: u32| {
            let chain = self.chains.get(ChainNumber(end as usize / 2));
            SpanKind::from_structure(self.network.structure_of(&chain))
        };
        let of_kind = |wanted: Option<SpanKind>| {
            ends.iter().copied().filter(move |&end| kind_of(end) == wanted)
        };
        let passes_through = |kind: Option<SpanKind>| {
            let directions: Vec<[f64; 2]> =
                of_kind(kind).take(MOST_ENDS).map(|end| self.direction(end)).collect();
            let mut rest = &directions[..];
            while let [one, others @ ..] = rest {
                if others.iter().any(|other| one[0] * other[0] + one[1] * other[1] < 0.0) {
                    return true;
                }
                rest = others;
            }
            false
        };
        let own = of_kind(Some(kind)).count();
        let has_ground = of_kind(None).next().is_some();
        joint.is_passed = passes_through(Some(kind));
        // If a street also passes through, it is between two bridges and carries both.
        if joint.is_passed && !passes_through(None) {
            joint.is_touched = has_ground;
            return;
        }
        joint.support = if has_ground {
            Some(Support::Ground)
        } else if own < ends.len() {
            Some(Support::OtherKind)
        } else if own == 1 && kind == SpanKind::Bridge {
            Some(Support::OpenEnd)
        } else {
            // A tunnel that ends where nothing continues may end inside the mountain, so the ground
            // gives no height.
            None
        };
    }

    /// Returns the vector from the node at an end of a chain to the point ten metres along the
    /// chain, or to the chain's other end.
    fn direction(&self, end: u32) -> [f64; 2] {
        let chain = self.chains.get(ChainNumber(end as usize / 2));
        let mut points = self.network.points_of_chain(&chain);
        if is_last(end) {
            points.reverse();
        }
        let Some(from) = points.first().map(|point| point.in_steps()) else { return [0.0; 2] };
        let away = |to: &[f64; 2]| (self.distance_m)(from, *to) >= DIRECTION_M;
        let mut others = points[1..].iter().map(|point| point.in_steps());
        let last = points.last().map_or(from, |point| point.in_steps());
        let to = others.find(away).unwrap_or(last);
        [to[0] - from[0], to[1] - from[1]]
    }
}

/// Whether an end of a chain is its last one.
fn is_last(end: u32) -> bool {
    end % 2 == 1
}

/// Assigns to each edge the number of its span: edges that share a joint have the same number.
/// Returns the number of spans.
fn number_spans(edges: &mut [SpanEdge], edges_at: &IndexLists) -> usize {
    const NONE: u32 = u32::MAX;
    let mut of_edge = vec![NONE; edges.len()];
    let mut count = 0;
    let mut waiting = Vec::new();
    for first in 0..edges.len() {
        if of_edge[first] != NONE {
            continue;
        }
        of_edge[first] = count;
        waiting.push(first);
        while let Some(edge) = waiting.pop() {
            for joint in edges[edge].joints {
                for &end in edges_at.list(joint as usize) {
                    let other = end as usize / 2;
                    if of_edge[other] == NONE {
                        of_edge[other] = count;
                        waiting.push(other);
                    }
                }
            }
        }
        count += 1;
    }
    for (edge, span) in edges.iter_mut().zip(of_edge) {
        edge.span = span;
    }
    count as usize
}

#[cfg(test)]
#[path = "span_finder_tests.rs"]
mod tests;
