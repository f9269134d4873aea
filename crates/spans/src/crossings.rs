//! Finds where bridges and tunnels cross other roads without a common node.

use std::collections::BTreeMap;

use corniche_geom::{LatticePoint, Side, along, cross, side};
use corniche_network::{ChainNumber, Chains, Network};
use rstar::{
    AABB, RTree,
    primitives::{GeomWithData, Rectangle},
};

use crate::{
    Distance,
    chain_lines::{ChainLine, ChainLines, OnLine},
    contacts::{Contact, contacts},
    crossing_place::CrossingPlace,
    spans::SpanKind,
};

/// Whether it is known which of two chains is above.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// The order is known, from the kinds of the chains or from their layers.
    Known,
    /// The order is unknown: both are bridges, or both are tunnels, of the same layer.
    Tie,
}

/// A crossing of two chains, at least one of which is a bridge or a tunnel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// The position on the lattice.
    pub at: [f64; 2],
    /// The upper chain; either chain if the order is unknown.
    pub upper: CrossingPlace,
    /// The lower chain.
    pub lower: CrossingPlace,
    /// Whether it is known which chain is above.
    pub order: Order,
    /// The distance that the crossing extends along both chains to either side, metres; 0 if they
    /// cross at one point.
    pub half_m: f64,
    /// Whether this belongs to the same crossing as the previous entry: a stretch that both share
    /// has several entries.
    pub continues: bool,
}

/// The crossings of a network.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Crossings {
    /// All crossings, in the order of their chains.
    pub all: Vec<Crossing>,
    /// Ways that cross others more often than any real way. The crossings of their chains are
    /// omitted.
    pub left_out: Vec<i64>,
}

/// The maximum number of segment pairs to compare, for each segment of a chain and in addition for
/// each chain; in a city there are a handful. A chain with more pairs is omitted.
const MOST_PAIRS_OF_SEGMENT: u64 = 64;
const MOST_PAIRS_OF_CHAIN: u64 = 1 << 16;
/// The maximum of the additional pairs for all chains together: a base, and an addition for each
/// segment of bridges and tunnels.
const MOST_PAIRS: u64 = 1 << 22;
const MORE_PAIRS_OF_SEGMENT: u64 = 1 << 6;
/// The maximum number of crossings of two chains; no real chains have as many.
const MOST_CROSSINGS: usize = 256;
/// The distance between the entries of a stretch that two lines share, metres, and the maximum
/// number of entries.
const SPACING_M: f64 = 10.0;
const MOST_PLACES: f64 = 64.0;

/// Returns all crossings of a network's bridges and tunnels with its roads and with each other.
///
/// Orientations are exact. Lines cross where one changes from one side of the other to its other
/// side. They may do so at a position where each has a point, or along a stretch that both share,
/// but not where they have a node in common. Roads that end on one another do not cross there.
///
/// The work is proportional to the number of points: chains that cross others more often than any
/// real chains are omitted.
#[must_use]
pub fn crossings(network: &Network, chains: &Chains, distance_m: &Distance<'_>) -> Crossings {
    let lines = ChainLines::new(network, chains, distance_m);
    let of_spans: Vec<ChainLine> = chains
        .numbers()
        .filter(|&chain| lines.kind_of(chain).is_some())
        .map(|chain| lines.line(chain))
        .collect();
    let mut finder = Finder::new(&lines, &of_spans);
    let mut own_number = 0;
    for chain in chains.numbers() {
        if of_spans.is_empty() {
            break;
        }
        match of_spans.get(own_number).filter(|line| line.chain == chain) {
            Some(line) => {
                finder.find(line, own_number);
                own_number += 1;
            }
            None => finder.find(&lines.line(chain), of_spans.len()),
        }
    }
    finder.finish()
}

/// The number of a line of a bridge or a tunnel, and the number of one of its segments.
type OfSegment = (u32, u32);
type Boxed = GeomWithData<Rectangle<[f64; 2]>, OfSegment>;

struct Finder<'a> {
    lines: &'a ChainLines<'a>,
    of_spans: &'a [ChainLine],
    tree: RTree<Boxed>,
    /// For each line of `of_spans`, whether it is omitted. It stays in the tree until the cost of
    /// meeting its boxes reaches the cost of a new tree.
    is_out: Vec<bool>,
    met_out: usize,
    found: Vec<Crossing>,
    /// Omitted chains, each with the way to report.
    left_out: BTreeMap<ChainNumber, i64>,
    /// The number of pairs that may be compared in addition to the pairs for each segment.
    pairs: u64,
}

/// The number of segments of bridges and tunnels that were met.
#[derive(Default)]
struct Met {
    pairs: u64,
    /// The number of further segments that belong to omitted lines.
    left_out: usize,
}

/// The findings between a line and a line of a bridge or a tunnel.
#[derive(Default)]
struct Between {
    pairs: u64,
    /// The crossings of the two lines, by the segments of both; a stretch that both share has
    /// several entries.
    crossings: BTreeMap<[usize; 2], Vec<Crossing>>,
    /// The positions where the lines touch.
    touching: BTreeMap<[OnLine; 2], LatticePoint>,
}

/// A line that crosses others more often than any real line.
enum Culprit {
    Own,
    /// The line of a bridge or a tunnel with this number.
    Other(usize),
}

impl<'a> Finder<'a> {
    fn new(lines: &'a ChainLines<'a>, of_spans: &'a [ChainLine]) -> Self {
        let boxes = of_spans.iter().enumerate().flat_map(|(number, line)| boxes(line, number));
        let tree = RTree::bulk_load(boxes.collect());
        let pairs = MOST_PAIRS + MORE_PAIRS_OF_SEGMENT * tree.size() as u64;
        let (is_out, met_out) = (vec![false; of_spans.len()], 0);
        let (found, left_out) = (Vec::new(), BTreeMap::new());
        Self { lines, of_spans, tree, is_out, met_out, found, left_out, pairs }
    }

    /// Finds the crossings of a line with the first `count` lines of bridges and tunnels, and also
    /// with itself if it is the next of them.
    fn find(&mut self, line: &ChainLine, count: usize) {
        let for_segments = MOST_PAIRS_OF_SEGMENT * line.segments() as u64;
        while !self.left_out.contains_key(&line.chain) {
            self.forget_left_out();
            let mut met = Met::default();
            let most = for_segments + MOST_PAIRS_OF_CHAIN.min(self.pairs);
            let found = self.try_find((line, count), most, &mut met);
            self.pairs = self.pairs.saturating_sub(met.pairs.saturating_sub(for_segments));
            self.met_out += met.left_out;
            match found {
                Ok(all) => {
                    let of_line = all.into_values().flat_map(|own| own.crossings.into_values());
                    self.found.extend(of_line.flatten());
                    return;
                }
                Err(Culprit::Own) => self.leave_out(line, count),
                Err(Culprit::Other(number)) => self.leave_out(&self.of_spans[number], number),
            }
        }
    }

    fn leave_out(&mut self, line: &ChainLine, number: usize) {
        self.left_out.insert(line.chain, self.lines.largest_way(line.chain));
        if line.kind.is_some() {
            self.is_out[number] = true;
        }
    }

    fn try_find(
        &self,
        (line, count): (&ChainLine, usize),
        most: u64,
        met: &mut Met,
    ) -> Result<BTreeMap<u32, Between>, Culprit> {
        let mut all: BTreeMap<u32, Between> = BTreeMap::new();
        for segment in 0..line.segments() {
            let [a, b] = line.segment(segment).map(LatticePoint::in_steps);
            let near = self.tree.locate_in_envelope_intersecting(&AABB::from_corners(a, b));
            // Each pair of segments is compared once.
            let place = (count as u32, segment as u32);
            for (number, other) in near.map(|of| of.data) {
                if self.is_out[number as usize] {
                    met.left_out += 1;
                    continue;
                }
                met.pairs += 1;
                let own = all.entry(number).or_default();
                own.pairs += 1;
                if (number, other) < place {
                    own.add([(line, segment), (&self.of_spans[number as usize], other as usize)]);
                }
                if own.crossings.len() > MOST_CROSSINGS {
                    return Err(self.larger(line, number as usize));
                }
                if met.pairs > most {
                    // If one other line has most of the pairs, that line is examined; otherwise
                    // this line has too many.
                    let half = all.iter().find(|(_, between)| 2 * between.pairs > met.pairs);
                    return Err(
                        half.map_or(Culprit::Own, |(&of, _)| self.larger(line, of as usize))
                    );
                }
            }
        }
        for (&number, own) in &mut all {
            let both = [line, &self.of_spans[number as usize]];
            for (on, at) in std::mem::take(&mut own.touching) {
                for found in contacts(self.lines, both, (at, on), &mut met.pairs) {
                    own.crossings.insert(found.segments, shared(both, &found));
                }
                if met.pairs > most {
                    return Err(self.larger(line, number as usize));
                }
            }
            if own.crossings.len() > MOST_CROSSINGS {
                return Err(self.larger(line, number as usize));
            }
        }
        Ok(all)
    }

    /// Builds a new tree without the omitted lines, once they cost as much as building it.
    fn forget_left_out(&mut self) {
        if self.met_out > self.tree.size() {
            let left = self.of_spans.iter().enumerate().filter(|(number, _)| !self.is_out[*number]);
            let boxes = left.flat_map(|(number, line)| boxes(line, number));
            (self.tree, self.met_out) = (RTree::bulk_load(boxes.collect()), 0);
        }
    }

    /// Returns the one of a line and a line of a bridge or a tunnel that has more points.
    fn larger(&self, line: &ChainLine, other: usize) -> Culprit {
        let is_other = self.of_spans[other].points.len() > line.points.len();
        if is_other { Culprit::Other(other) } else { Culprit::Own }
    }

    fn finish(self) -> Crossings {
        let Self { found: mut all, left_out, .. } = self;
        all.retain(|crossing| {
            [crossing.upper, crossing.lower].iter().all(|at| !left_out.contains_key(&at.chain))
        });
        let mut left_out: Vec<i64> = left_out.into_values().collect();
        left_out.sort_unstable();
        Crossings { all, left_out }
    }
}

fn boxes(line: &ChainLine, number: usize) -> impl Iterator<Item = Boxed> + '_ {
    (0..line.segments()).map(move |segment| {
        let [a, b] = line.segment(segment).map(LatticePoint::in_steps);
        GeomWithData::new(Rectangle::from_corners(a, b), (number as u32, segment as u32))
    })
}

impl Between {
    /// Compares a pair of segments.
    fn add(&mut self, both: [(&ChainLine, usize); 2]) {
        let [(own, own_segment), (other, other_segment)] = both;
        let [[a, b], [c, d]] = both.map(|(line, segment)| line.segment(segment));
        let of_own = [c, d].map(|end| side(a, b, end));
        let of_other = [a, b].map(|end| side(c, d, end));
        let opposite = [[Side::Left, Side::Right], [Side::Right, Side::Left]];
        if opposite.contains(&of_own) && opposite.contains(&of_other) {
            self.crossings.insert([own_segment, other_segment], vec![crossed(both)]);
        } else if own.chain != other.chain {
            let within = |[from, to]: [LatticePoint; 2], at: LatticePoint| {
                let is = |from: i64, to: i64, at: i64| from.min(to) <= at && at <= from.max(to);
                is(from.u, to.u, at.u) && is(from.v, to.v, at.v)
            };
            let others = [c, d].into_iter().zip(of_own).filter(|(at, _)| within([a, b], *at));
            let owns = [a, b].into_iter().zip(of_other).filter(|(at, _)| within([c, d], *at));
            for (at, _) in others.chain(owns).filter(|(_, side)| *side == Side::On) {
                let on = [own.on(own_segment, at), other.on(other_segment, at)];
                self.touching.insert(on, at);
            }
        }
    }
}

/// Returns the crossing of two segments, each of which extends to both sides of the other.
fn crossed(both: [(&ChainLine, usize); 2]) -> Crossing {
    let [[a, b], [c, d]] = both.map(|(line, segment)| line.segment(segment));
    let share = |[from, to]: [LatticePoint; 2], [one, two]: [LatticePoint; 2]| {
        let [of_from, of_to] = [from, to].map(|end| cross(one, two, end) as f64);
        of_from / (of_from - of_to)
    };
    let shares = [share([a, b], [c, d]), share([c, d], [a, b])];
    let at = along(a.in_steps(), b.in_steps(), shares[0]);
    let places = [0, 1].map(|k| {
        let (line, segment) = both[k];
        line.place(segment, line.along_m(segment, shares[k]))
    });
    Crossing::new(at, places, 0.0, false)
}

/// Returns the entries of a stretch that two crossing lines share; the second line is a bridge or a
/// tunnel.
fn shared(both: [&ChainLine; 2], contact: &Contact) -> Vec<Crossing> {
    let [_, [from_m, to_m]] = contact.along_m;
    let length_m = (to_m - from_m).abs();
    let count = (length_m / SPACING_M).ceil().clamp(1.0, MOST_PLACES);
    let of_share = |share: f64| {
        let [own_m, other_m] =
            contact.along_m.map(|[from_m, to_m]| from_m + share * (to_m - from_m));
        let (segment, at) = both[1].at_m(other_m);
        let places = [both[0].place(contact.segments[0], own_m), both[1].place(segment, other_m)];
        (at, places)
    };
    (0..count as usize)
        .map(|k| {
            let (at, places) = of_share((k as f64 + 0.5) / count);
            Crossing::new(at, places, length_m / count / 2.0, k > 0)
        })
        .collect()
}

impl Crossing {
    /// Returns the place that moves to make space, and the place that it avoids. A bridge is
    /// lifted. Above a tunnel, of two tunnels, and beneath the ground, the lower one is lowered.
    /// Heights of the first place depend on those of the second.
    #[must_use]
    pub fn moved(&self) -> [CrossingPlace; 2] {
        match (self.upper.kind, self.lower.kind) {
            (Some(SpanKind::Bridge), None | Some(SpanKind::Bridge)) => [self.upper, self.lower],
            _ => [self.lower, self.upper],
        }
    }

    fn new(at: [f64; 2], [one, two]: [CrossingPlace; 2], half_m: f64, continues: bool) -> Self {
        let above = one.order(&two);
        let order = if above.is_eq() { Order::Tie } else { Order::Known };
        let [upper, lower] = if above.is_ge() { [one, two] } else { [two, one] };
        Self { at, upper, lower, order, half_m, continues }
    }
}

#[cfg(test)]
#[path = "crossings_tests.rs"]
mod tests;
