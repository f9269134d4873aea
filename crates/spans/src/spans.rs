//! The networks of structure ways, and the joints at which they are carried.

use corniche_geom::{IndexLists, LatticePoint};
use corniche_network::{ChainNumber, NodeNumber};
use corniche_roads::Structure;

/// What a span is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SpanKind {
    /// A bridge: never below the ground.
    Bridge,
    /// A tunnel: never above the ground.
    Tunnel,
}

impl SpanKind {
    /// The kind of span that a road with a structure is; `None` on the ground.
    #[must_use]
    pub fn of(structure: Structure) -> Option<Self> {
        match structure {
            Structure::Ground => None,
            Structure::Bridge => Some(Self::Bridge),
            Structure::Tunnel => Some(Self::Tunnel),
        }
    }

    /// Which way is away from the ground: 1 for up, −1 for down.
    #[must_use]
    pub fn away(self) -> f64 {
        match self {
            Self::Bridge => 1.0,
            Self::Tunnel => -1.0,
        }
    }
}

/// Why a joint has the height of the ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Support {
    /// A road on the ground goes on there.
    Ground,
    /// A bridge goes on as a tunnel, or a tunnel as a bridge.
    OtherKind,
    /// A bridge ends where nothing goes on: at a pier's end, or where the data ends.
    OpenEnd,
    /// A road on the ground touches the span, which nothing else carries.
    Touching,
}

/// A node where chains of a span meet or end.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Joint {
    /// Its node.
    pub node: NodeNumber,
    /// OSM's id of the node; `None` where a road is cut.
    pub node_id: Option<i64>,
    /// Where it lies.
    pub at: LatticePoint,
    /// Why it has the ground's height, unless that is refused as wrong; `None` where it is free.
    pub support: Option<Support>,
    /// Whether the span passes through.
    pub(crate) is_passed: bool,
    /// Whether the span passes through, and a way on the ground only touches it.
    pub(crate) is_touched: bool,
}

/// A chain of a span.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Edge {
    pub(crate) chain: ChainNumber,
    pub(crate) kind: SpanKind,
    pub(crate) span: u32,
    /// The joints at its ends.
    pub(crate) joints: [u32; 2],
    pub(crate) length_m: f64,
    /// The smallest id of its ways.
    pub(crate) way_id: i64,
    /// The steepest grade with which roads of the kinds of its ways are built, rise over run.
    pub(crate) steepest: f64,
}

/// What is wrong with a span, or worth to be known of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SpanReason {
    /// Nothing carries it: it stays on the ground.
    NoSupport,
    /// One support carries it: it is level.
    OneSupport,
    /// A bridge ends where nothing goes on.
    OpenEnd,
    /// A way on the ground touches it where it passes through.
    GroundWayOnDeck,
    /// It goes on as the other kind.
    KindChange,
    /// It crosses another span of the same layer: nothing says which is above.
    LayerTie,
    /// It is less than a metre above or below what it crosses.
    OrderUnreachable,
    /// It is on the wrong side of what it crosses.
    OrderReversed,
    /// Some of its supports lie where there is no ground.
    NoGround,
    /// It joins so many ways that not all of it is solved.
    TooIntricate,
    /// It crosses others more often than any real one.
    TooManyCrossings,
    /// It is steeper than roads of its kind are built.
    GradeOverLimit,
    /// The ground between the ends of a bridge is more than a metre above where the deck would be.
    DeckInGround,
    /// The ground between the portals of a tunnel is more than a metre below where the tunnel would be.
    TunnelAboveGround,
}

impl SpanReason {
    /// What it is called in reports.
    #[must_use]
    pub fn id(self) -> &'static str {
        self.texts()[0]
    }

    /// What it means, in words.
    #[must_use]
    pub fn words(self) -> &'static str {
        self.texts()[1]
    }

    fn texts(self) -> [&'static str; 2] {
        match self {
            Self::NoSupport => {
                ["span_no_support", "no road on the ground meets its ends: it stays on the ground"]
            }
            Self::OneSupport => ["span_one_support", "one end alone meets the ground: it is level"],
            Self::OpenEnd => [
                "span_open_end",
                "a bridge that ends where nothing goes on has the ground's height there",
            ],
            Self::GroundWayOnDeck => [
                "ground_way_on_deck",
                "a road on the ground meets it between its ends, and does not carry it",
            ],
            Self::KindChange => {
                ["kind_change", "a bridge goes on as a tunnel: the joint has the ground's height"]
            }
            Self::LayerTie => [
                "layer_tie",
                "it crosses another one of the same layer: nothing says which is above",
            ],
            Self::OrderUnreachable => {
                ["order_unreachable", "less than a metre above or below what it crosses"]
            }
            Self::OrderReversed => ["order_reversed", "on the wrong side of what it crosses"],
            Self::NoGround => ["no_ground", "an end lies where there is no ground"],
            Self::TooIntricate => [
                "span_too_intricate",
                "it joins too many ways, or has too many points: what is not solved of it stays on the ground",
            ],
            Self::TooManyCrossings => [
                "too_many_crossings",
                "it crosses bridges, tunnels or other roads too often: nothing is lifted for its crossings",
            ],
            Self::GradeOverLimit => {
                ["grade_over_limit", "steeper than roads of its kind are built"]
            }
            Self::DeckInGround => [
                "deck_in_ground",
                "the ground beneath is more than a metre above the line between its ends",
            ],
            Self::TunnelAboveGround => [
                "tunnel_above_ground",
                "the ground above is more than a metre below the line between its ends",
            ],
        }
    }

    /// All of them.
    pub const ALL: [Self; 14] = [
        Self::NoSupport,
        Self::OneSupport,
        Self::OpenEnd,
        Self::GroundWayOnDeck,
        Self::KindChange,
        Self::LayerTie,
        Self::OrderUnreachable,
        Self::OrderReversed,
        Self::NoGround,
        Self::TooIntricate,
        Self::TooManyCrossings,
        Self::GradeOverLimit,
        Self::DeckInGround,
        Self::TunnelAboveGround,
    ];
}

/// A reason with the way at which it was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct SpanProblem {
    /// What it is.
    pub reason: SpanReason,
    /// A way of the span; of several the one with the smallest id.
    pub way_id: i64,
    /// The node at which it is so, if it is so at a node.
    pub node_id: Option<i64>,
}

impl SpanProblem {
    /// Something of a whole way.
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
    /// The number of its span, from 0.
    pub span: usize,
    /// How long it is, metres.
    pub length_m: f64,
}

/// All bridges and tunnels of a network.
#[derive(Debug, Clone)]
pub struct Spans {
    /// In the order of their chains.
    pub(crate) edges: Vec<Edge>,
    /// Bridges and tunnels have different ones, also at the same node.
    pub(crate) joints: Vec<Joint>,
    /// The ends of edges at each joint: twice the number of the edge, plus one for its last end.
    pub(crate) edges_at: IndexLists,
    pub(crate) count: usize,
}

impl Spans {
    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The joints of all spans.
    #[must_use]
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// The chains of all spans.
    pub fn chains(&self) -> impl Iterator<Item = SpanChain> + '_ {
        self.edges.iter().map(|&Edge { chain, kind, span, length_m, .. }| SpanChain {
            chain,
            kind,
            span: span as usize,
            length_m,
        })
    }

    /// The span of each joint, in their order.
    pub fn spans_of_joints(&self) -> impl Iterator<Item = Option<usize>> + '_ {
        (0..self.joints.len()).map(|joint| {
            let end = *self.edges_at.of(joint).first()?;
            Some(self.edges[end as usize / 2].span as usize)
        })
    }

    /// The span of a chain; `None` on the ground.
    #[must_use]
    pub fn span_of(&self, chain: ChainNumber) -> Option<usize> {
        Some(self.edges[self.edge_of(chain)?].span as usize)
    }

    /// The edge of a chain; `None` on the ground.
    pub(crate) fn edge_of(&self, chain: ChainNumber) -> Option<usize> {
        self.edges.binary_search_by_key(&chain, |edge| edge.chain).ok()
    }

    /// The smallest id of the ways that meet in a joint.
    pub(crate) fn way_of_joint(&self, joint: usize) -> i64 {
        let ends = self.edges_at.of(joint).iter();
        ends.map(|end| self.edges[*end as usize / 2].way_id).min().unwrap_or_default()
    }

    /// A reason to look at a joint.
    pub(crate) fn problem_of_joint(&self, reason: SpanReason, joint: usize) -> SpanProblem {
        let node_id = self.joints[joint].node_id;
        SpanProblem { reason, way_id: self.way_of_joint(joint), node_id }
    }

    /// What is to be told of how spans are carried, where supports at some joints are refused.
    pub(crate) fn problems(&self, is_refused: &[bool]) -> Vec<SpanProblem> {
        let mut supports = vec![0_u64; self.count];
        let mut first_ways = vec![i64::MAX; self.count];
        let mut problems = Vec::new();
        for edge in &self.edges {
            let first = &mut first_ways[edge.span as usize];
            *first = edge.way_id.min(*first);
        }
        for (number, (joint, &is_refused)) in self.joints.iter().zip(is_refused).enumerate() {
            let ends = self.edges_at.of(number);
            let Some(&end) = ends.first() else { continue };
            let span = self.edges[end as usize / 2].span as usize;
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
