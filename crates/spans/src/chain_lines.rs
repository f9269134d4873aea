//! The lines of chains, with the data needed where they meet other lines.

use corniche_geom::{IndexLists, LatticePoint, along};
use corniche_network::{ChainNumber, Chains, Network, NodeNumber};

use crate::{
    Distance,
    crossing_place::{CrossingPlace, steepest_of},
    spans::SpanKind,
};

/// The maximum number of chains at a node that are considered; no real node has as many.
const MOST_RAYS: usize = 16;

/// The line of a chain.
pub(crate) struct ChainLine {
    pub chain: ChainNumber,
    pub kind: Option<SpanKind>,
    pub points: Vec<LatticePoint>,
    /// The node of each point at which roads may join.
    nodes: Vec<Option<NodeNumber>>,
    /// The distance of each point along the chain, metres. It is 0 on the ground, where it is not
    /// needed.
    alongs_m: Vec<f64>,
    /// The properties of its segments, each with the first segment to which they apply.
    parts: Vec<(usize, CrossingPlace)>,
}

/// A position on a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum OnLine {
    /// At a point of the line.
    Point(usize),
    /// Within a segment of the line.
    Segment(usize),
}

/// One direction in which a line leaves a position. At an end of a chain, the other chains of its
/// kind also count.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ChainRay {
    /// The chain that leaves in this direction.
    pub chain: ChainNumber,
    /// The next point in this direction.
    pub to: LatticePoint,
    pub onward: Onward,
}

/// The continuation of a line.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Onward {
    /// The line continues at one of its own points.
    Own(NextPoint),
    /// The line continues on another chain, from that chain's first or last point.
    Other { is_from_last: bool },
}

/// A point of a line, as reached from another position on it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NextPoint {
    pub point: usize,
    pub is_forward: bool,
}

impl NextPoint {
    /// Returns the segment that ends at the point.
    pub(crate) fn segment(self) -> usize {
        if self.is_forward { self.point - 1 } else { self.point }
    }
}

/// Builds the lines of chains.
pub(crate) struct ChainLines<'a> {
    network: &'a Network,
    chains: &'a Chains,
    distance_m: &'a Distance<'a>,
    ends_at: IndexLists,
}

impl<'a> ChainLines<'a> {
    pub(crate) fn new(
        network: &'a Network,
        chains: &'a Chains,
        distance_m: &'a Distance<'a>,
    ) -> Self {
        Self { network, chains, distance_m, ends_at: chains.ends_at(network, |_| true) }
    }

    pub(crate) fn kind_of(&self, chain: ChainNumber) -> Option<SpanKind> {
        SpanKind::from_structure(self.network.structure_of(&self.chains.get(chain)))
    }

    pub(crate) fn line(&self, chain: ChainNumber) -> ChainLine {
        let kind = self.kind_of(chain);
        let mut line = ChainLine {
            chain,
            kind,
            points: Vec::new(),
            nodes: Vec::new(),
            alongs_m: Vec::new(),
            parts: Vec::new(),
        };
        for &link in self.chains.get(chain).links {
            let way = self.network.way_of(link);
            let layer = kind.map_or(0, |_| way.layer);
            let steepest = steepest_of(self.network, way);
            let (way_id, is_railway) = (way.way_id, way.railway.is_some());
            let place =
                CrossingPlace { chain, way_id, along_m: 0.0, kind, layer, steepest, is_railway };
            let [from, to] = self.network.nodes_of_link(link);
            let first = line.points.len().saturating_sub(1);
            line.parts.push((first, place));
            for (index, point) in self.network.points_of_link(link).enumerate() {
                match line.points.last() {
                    Some(_) if index == 0 => continue,
                    Some(before) => {
                        let along_m = line.alongs_m.last().copied().unwrap_or_default();
                        let more_m = match kind {
                            Some(_) => (self.distance_m)(before.in_steps(), point.in_steps()),
                            None => 0.0,
                        };
                        line.alongs_m.push(along_m + more_m);
                        line.nodes.push(None);
                    }
                    None => {
                        line.alongs_m.push(0.0);
                        line.nodes.push(Some(from));
                    }
                }
                line.points.push(point);
            }
            if let Some(last) = line.nodes.last_mut() {
                *last = Some(to);
            }
        }
        line
    }

    /// Returns the directions in which a line leaves a position.
    pub(crate) fn rays(&self, line: &ChainLine, at: OnLine) -> Vec<ChainRay> {
        let chain = line.chain;
        let last = line.points.len() - 1;
        let ray = |point: usize, is_forward: bool| ChainRay {
            chain,
            to: line.points[point],
            onward: Onward::Own(NextPoint { point, is_forward }),
        };
        match at {
            OnLine::Segment(first) => vec![ray(first, false), ray(first + 1, true)],
            OnLine::Point(point) if point > 0 && point < last => {
                vec![ray(point - 1, false), ray(point + 1, true)]
            }
            OnLine::Point(point) => {
                let node = line.nodes[point];
                let mut rays = Vec::new();
                if point == 0 || line.nodes[0] == node {
                    rays.push(ray(1, true));
                }
                if point == last || line.nodes[last] == node {
                    rays.push(ray(last - 1, false));
                }
                let ends =
                    node.map_or(&[][..], |node| self.ends_at.list(self.network.index_of(node)));
                let others = ends.iter().take(MOST_RAYS).filter_map(|&end| {
                    let other = ChainNumber(end as usize / 2);
                    let is_other = other != chain && self.kind_of(other) == line.kind;
                    let is_from_last = end % 2 == 1;
                    let to = is_other.then(|| self.beside(other, is_from_last))??;
                    Some(ChainRay { chain: other, to, onward: Onward::Other { is_from_last } })
                });
                rays.extend(others);
                rays
            }
        }
    }

    /// Returns the line of a chain, unless the chain has more than `most_points`.
    pub(crate) fn line_within(&self, chain: ChainNumber, most_points: usize) -> Option<ChainLine> {
        let links = self.chains.get(chain).links;
        let points = links.iter().flat_map(|&link| self.network.points_of_link(link));
        (points.take(most_points + 1).count() <= most_points).then(|| self.line(chain))
    }

    /// Returns the point next to an end of a chain.
    fn beside(&self, chain: ChainNumber, is_last: bool) -> Option<LatticePoint> {
        let links = self.chains.get(chain).links;
        if is_last {
            self.network.points_of_link(*links.last()?).rev().nth(1)
        } else {
            self.network.points_of_link(*links.first()?).nth(1)
        }
    }

    /// Returns the way of a chain that has the most points.
    pub(crate) fn largest_way(&self, chain: ChainNumber) -> i64 {
        let links = self.chains.get(chain).links;
        let own = links.iter().map(|&link| {
            let way = self.network.way_of(link);
            (self.network.points_of(way).len(), std::cmp::Reverse(way.way_id))
        });
        own.max().map_or(0, |(_, way_id)| way_id.0)
    }
}

impl ChainLine {
    /// Returns the number of segments.
    pub(crate) fn segments(&self) -> usize {
        self.points.len() - 1
    }

    /// Returns the ends of a segment.
    pub(crate) fn segment(&self, first: usize) -> [LatticePoint; 2] {
        [self.points[first], self.points[first + 1]]
    }

    /// Returns the position on the line of a point on a segment, which may be one of the segment's
    /// ends. Both ends of a ring are one position.
    pub(crate) fn on(&self, segment: usize, at: LatticePoint) -> OnLine {
        let [from, to] = self.segment(segment);
        if at == from {
            self.at_point(segment)
        } else if at == to {
            self.at_point(segment + 1)
        } else {
            OnLine::Segment(segment)
        }
    }

    /// Returns the position of a point.
    pub(crate) fn at_point(&self, point: usize) -> OnLine {
        let last = self.points.len() - 1;
        OnLine::Point(if point == last && self.nodes[0] == self.nodes[last] { 0 } else { point })
    }

    /// Returns the node at a position.
    pub(crate) fn node(&self, at: OnLine) -> Option<NodeNumber> {
        match at {
            OnLine::Point(point) => self.nodes[point],
            OnLine::Segment(_) => None,
        }
    }

    /// Whether a position is an end of the line.
    pub(crate) fn is_end(&self, at: OnLine) -> bool {
        at == OnLine::Point(0) || at == OnLine::Point(self.segments())
    }

    /// Returns a segment that contains a position.
    pub(crate) fn segment_at(&self, at: OnLine) -> usize {
        match at {
            OnLine::Point(point) => point.min(self.segments() - 1),
            OnLine::Segment(first) => first,
        }
    }

    /// Returns the crossing place at a distance along the line, which is on a segment.
    pub(crate) fn place(&self, segment: usize, along_m: f64) -> CrossingPlace {
        let part = self.parts.partition_point(|(first, _)| *first <= segment);
        CrossingPlace { along_m, ..self.parts[part - 1].1 }
    }

    /// Returns the distance along the line of the position at a fraction of a segment.
    pub(crate) fn along_m(&self, segment: usize, share: f64) -> f64 {
        let [from_m, to_m] = [segment, segment + 1].map(|point| self.alongs_m[point]);
        from_m + share * (to_m - from_m)
    }

    /// Returns the distance along the line of a point on a segment.
    pub(crate) fn along_of_m(&self, segment: usize, at: LatticePoint) -> f64 {
        let [from, to] = self.segment(segment);
        self.along_m(segment, from.distance_steps(at) / from.distance_steps(to))
    }

    /// Returns the segment at a distance along the line, and the position there.
    pub(crate) fn at_m(&self, along_m: f64) -> (usize, [f64; 2]) {
        let after = self.alongs_m.partition_point(|&own_m| own_m <= along_m);
        let segment = after.clamp(1, self.segments()) - 1;
        let [from, to] = self.segment(segment).map(LatticePoint::in_steps);
        let [from_m, to_m] = [segment, segment + 1].map(|point| self.alongs_m[point]);
        let share = ((along_m - from_m) / (to_m - from_m)).clamp(0.0, 1.0);
        (segment, along(from, to, share))
    }
}
