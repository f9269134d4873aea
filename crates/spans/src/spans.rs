//! The networks of bridges and tunnels, and the joints at which they are carried.

use corniche_geom::{IndexLists, LatticePoint};
use corniche_network::{ChainNumber, NodeNumber};
use corniche_roads::Structure;

/// The kind of a span.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SpanKind {
    /// A bridge: never below the ground.
    Bridge,
    /// A tunnel: never above the ground.
    Tunnel,
}

impl SpanKind {
    /// Returns the kind of span of a road with a structure; `None` on the ground.
    #[must_use]
    pub fn from_structure(structure: Structure) -> Option<Self> {
        match structure {
            Structure::Ground => None,
            Structure::Bridge => Some(Self::Bridge),
            Structure::Tunnel => Some(Self::Tunnel),
        }
    }

    /// Returns the direction away from the ground: 1 for up, −1 for down.
    #[must_use]
    pub fn away(self) -> f64 {
        match self {
            Self::Bridge => 1.0,
            Self::Tunnel => -1.0,
        }
    }
}

/// The reason why a joint has the height of the ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Support {
    /// A road on the ground continues there.
    Ground,
    /// A bridge continues as a tunnel, or a tunnel as a bridge.
    OtherKind,
    /// A bridge ends where nothing continues: at the end of a pier, or where the data ends.
    OpenEnd,
    /// A road on the ground touches the span, which nothing else carries.
    Touching,
}

/// A node where chains of a span meet or end.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Joint {
    /// The node of the joint.
    pub node: NodeNumber,
    /// OSM's id of the node; `None` where a road is cut.
    pub node_id: Option<i64>,
    /// The position of the joint.
    pub at: LatticePoint,
    /// The reason why the joint has the ground's height, unless that is refused as wrong; `None` if
    /// the joint is free.
    pub support: Option<Support>,
    /// Whether the span passes through the joint.
    pub(crate) is_passed: bool,
    /// Whether the span passes through the joint, and a way on the ground only touches it.
    pub(crate) is_touched: bool,
}

/// A chain of a span.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SpanEdge {
    pub chain: ChainNumber,
    pub kind: SpanKind,
    pub span: u32,
    /// The joints at the ends of the chain.
    pub joints: [u32; 2],
    pub length_m: f64,
    /// The smallest id of the chain's ways.
    pub way_id: i64,
    /// The steepest grade with which roads of the kinds of the chain's ways are built, rise over
    /// run.
    pub steepest: f64,
}

corniche_roads::listed! {
    /// A problem of a span, or a fact worth knowing about it.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum SpanReason {
        /// Nothing carries the span, so it stays on the ground.
        NoSupport = [
                "span_no_support",
                "no road on the ground meets the ends of the span, so the span stays on the ground",
            ],
        /// One support carries the span, so it is level.
        OneSupport = ["span_one_support", "only one end meets the ground, so the span is level"],
        /// A bridge ends where nothing continues.
        OpenEnd = [
                "span_open_end",
                "a bridge ends where no road continues; the end has the height of the ground",
            ],
        /// A way on the ground touches the span where it passes through.
        GroundWayOnDeck = [
                "ground_way_on_deck",
                "a road on the ground meets the span between the ends, and does not carry the span",
            ],
        /// The span continues as the other kind.
        KindChange = [
                "kind_change",
                "a bridge continues as a tunnel; the point between has the height of the ground",
            ],
        /// The span crosses another span of the same layer, so it is unknown which is above.
        LayerTie = [
                "layer_tie",
                "the span crosses another span of the same layer; which is above is unknown",
            ],
        /// The span is less than a metre above or below the road that it crosses.
        OrderUnreachable = [
                "order_unreachable",
                "the span and the road that crosses the span are less than a metre apart in height",
            ],
        /// The span is on the wrong side of the road that it crosses.
        OrderReversed = [
                "order_reversed",
                "the span is above a road that should cross over the span, or the other way round",
            ],
        /// Some supports of the span are where there is no ground.
        NoGround = ["no_ground", "an end of the span is where there is no ground"],
        /// The span joins so many ways that not all of it is solved.
        TooIntricate = [
                "span_too_intricate",
                "the span joins too many ways or has too many points; the unsolved parts stay on the ground",
            ],
        /// The way crosses others more often than any real way.
        TooManyCrossings = [
                "too_many_crossings",
                "the way crosses bridges, tunnels or other roads too often; nothing is raised at these crossings",
            ],
        /// The span is steeper than roads of its kind are built.
        GradeOverLimit = [
                "grade_over_limit",
                "the span is steeper than roads of that `highway` value are built",
            ],
        /// The ground between the ends of a bridge is more than a metre above where the deck would
        /// be.
        DeckInGround = [
                "deck_in_ground",
                "the ground under a bridge is more than a metre above the line between the bridge's ends",
            ],
        /// The ground between the portals of a tunnel is more than a metre below where the tunnel
        /// would be.
        TunnelAboveGround = [
                "tunnel_above_ground",
                "the ground over a tunnel is more than a metre below the line between the tunnel's ends",
            ],
    }

    /// Returns the name of the reason in reports, and its meaning.
    fn texts() -> [&'static str; 2];
}

impl SpanReason {
    /// Returns the name of the reason in reports.
    #[must_use]
    pub fn id(self) -> &'static str {
        self.texts()[0]
    }

    /// Returns the meaning of the reason, in words.
    #[must_use]
    pub fn words(self) -> &'static str {
        self.texts()[1]
    }
}

/// A reason, with the way at which it was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct SpanProblem {
    /// The reason.
    pub reason: SpanReason,
    /// A way of the span; of several ways, the one with the smallest id.
    pub way_id: i64,
    /// The node to which the reason applies, if it applies to a node.
    pub node_id: Option<i64>,
}

impl SpanProblem {
    /// Creates a problem that concerns a whole way.
    #[must_use]
    pub fn of_way(reason: SpanReason, way_id: i64) -> Self {
        Self { reason, way_id, node_id: None }
    }
}

/// A chain of a span.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpanChain {
    /// The chain.
    pub chain: ChainNumber,
    /// Whether it is a bridge or a tunnel.
    pub kind: SpanKind,
    /// The number of the span that contains it, from 0.
    pub span: usize,
    /// The length of the chain, metres.
    pub length_m: f64,
}

/// All bridges and tunnels of a network.
#[derive(Debug, Clone)]
pub struct Spans {
    /// The chains of all spans, in the order of the chains.
    pub(crate) edges: Vec<SpanEdge>,
    /// The joints. Bridges and tunnels have different joints, even at the same node.
    pub(crate) joints: Vec<Joint>,
    /// The ends of edges at each joint: twice the number of the edge, plus one for its last end.
    pub(crate) edges_at: IndexLists,
    pub(crate) count: usize,
}

impl Spans {
    /// Returns the number of chains.
    #[must_use]
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are no chains.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Returns the joints of all spans.
    #[must_use]
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// Returns the chains of all spans.
    pub fn chains(&self) -> impl Iterator<Item = SpanChain> + '_ {
        self.edges.iter().map(|&SpanEdge { chain, kind, span, length_m, .. }| SpanChain {
            chain,
            kind,
            span: span as usize,
            length_m,
        })
    }

    /// Returns the span of each joint, in the order of the joints.
    pub fn spans_of_joints(&self) -> impl Iterator<Item = Option<usize>> + '_ {
        (0..self.joints.len()).map(|joint| self.span_of_joint(joint))
    }

    /// Returns the span of a joint.
    pub(crate) fn span_of_joint(&self, joint: usize) -> Option<usize> {
        self.edges_of(joint).next().map(|edge| edge.span as usize)
    }

    /// Returns the edges that end at a joint; an edge with both ends there occurs twice.
    pub(crate) fn edges_of(&self, joint: usize) -> impl Iterator<Item = &SpanEdge> {
        self.edges_at.list(joint).iter().map(|&end| &self.edges[end as usize / 2])
    }

    /// Returns the joints at the other ends of these edges, and their distances, metres.
    pub(crate) fn neighbours(&self, joint: usize) -> impl Iterator<Item = (u32, f64)> {
        self.edges_at.list(joint).iter().map(|&end| {
            let SpanEdge { joints, length_m, .. } = &self.edges[end as usize / 2];
            (joints[1 - end as usize % 2], *length_m)
        })
    }

    /// Returns the span of a chain; `None` on the ground.
    #[must_use]
    pub fn span_of(&self, chain: ChainNumber) -> Option<usize> {
        Some(self.edges[self.edge_of(chain)?].span as usize)
    }

    /// Returns the edge of a chain; `None` on the ground.
    pub(crate) fn edge_of(&self, chain: ChainNumber) -> Option<usize> {
        self.edges.binary_search_by_key(&chain, |edge| edge.chain).ok()
    }

    /// Returns the smallest id of the ways that meet at a joint.
    pub(crate) fn way_of_joint(&self, joint: usize) -> i64 {
        self.edges_of(joint).map(|edge| edge.way_id).min().unwrap_or_default()
    }

    /// Creates a problem that concerns a joint.
    pub(crate) fn problem_of_joint(&self, reason: SpanReason, joint: usize) -> SpanProblem {
        let node_id = self.joints[joint].node_id;
        SpanProblem { reason, way_id: self.way_of_joint(joint), node_id }
    }

    /// Returns the problems of how spans are carried, given the joints whose supports are refused.
    pub(crate) fn problems(&self, is_refused: &[bool]) -> Vec<SpanProblem> {
        let mut supports = vec![0_u64; self.count];
        let mut first_ways = vec![i64::MAX; self.count];
        let mut problems = Vec::new();
        for edge in &self.edges {
            let first = &mut first_ways[edge.span as usize];
            *first = edge.way_id.min(*first);
        }
        for (number, (joint, &is_refused)) in self.joints.iter().zip(is_refused).enumerate() {
            let Some(span) = self.span_of_joint(number) else { continue };
            supports[span] += u64::from(joint.support.is_some() && !is_refused);
            let reason = match joint.support {
                Some(Support::OtherKind) => SpanReason::KindChange,
                Some(Support::OpenEnd) => SpanReason::OpenEnd,
                _ if is_refused => SpanReason::GroundWayOnDeck,
                None if joint.is_touched => SpanReason::GroundWayOnDeck,
                _ => continue,
            };
            problems.push(self.problem_of_joint(reason, number));
        }
        for (count, way_id) in supports.into_iter().zip(first_ways) {
            let reason = match count {
                0 => SpanReason::NoSupport,
                1 => SpanReason::OneSupport,
                _ => continue,
            };
            problems.push(SpanProblem::of_way(reason, way_id));
        }
        problems
    }
}

#[cfg(test)]
#[path = "spans_tests.rs"]
mod tests;
