//! Finds joints at which the ground does not carry a span, although a road on the ground shares a
//! node with it.
//!
//! ```text
//!   ●━━━━━━━━━━━●━━━━━━━━━━━●
//!
//!    ╲____ ─────●───── ____╱
//! ```
//!
//! A viaduct and the street in the valley beneath it may share a node, as in thousands of places in
//! OpenStreetMap. The ground there is far from the line between the other supports: farther than a
//! road of that kind climbs from the nearest of them. So the joint is refused as a support.

use std::{
    cmp::Reverse,
    collections::{BTreeMap, BTreeSet, BinaryHeap},
};

use corniche_network::NodeNumber;

use crate::{
    crossings::{Crossing, Order},
    harmonic::Harmonic,
    spans::{Spans, Support},
};

/// The maximum number of free joints between supports; real spans have some hundred at most.
const MOST_JOINTS: usize = 1024;
/// The maximum number of joints and chains to visit: a base, and an addition for each joint.
const MOST_STEPS: usize = 1 << 20;
const MOST_STEPS_OF_JOINT: usize = 1 << 6;
/// Differences are compared in whole micrometres, so that rounding errors decide nothing.
const STEP_M: f64 = 1e-6;

/// The results for all joints.
pub(crate) struct Refusals {
    pub is_refused: Vec<bool>,
    /// Joints with so many others around them that they were not solved.
    pub unsolved: Vec<usize>,
}

/// The order of joints: the one that is farther from the line, or that has the smaller node, comes
/// last.
type Key = (u64, Reverse<NodeNumber>, usize);

struct Finder<'a> {
    spans: &'a Spans,
    /// The height of each joint that carries its span; NaN for other joints.
    held_m: Vec<f64>,
    steps: usize,
    found: Refusals,
    /// Joints to refuse unless another one is refused first, with the keys that order them.
    waiting: BTreeSet<Key>,
    keys: BTreeMap<usize, Key>,
}

impl Refusals {
    /// Decides which supports are refused, with the ground known at all joints and crossings.
    ///
    /// Among the joints through which a span passes, the candidate is the one whose ground is
    /// farthest from the line that is solved without it. It is refused if the difference, divided
    /// by the distance to the nearest other support, exceeds the limit of the gentlest of its ways.
    /// Then the remaining joints are checked again. Ends are never refused.
    pub(crate) fn find(
        spans: &Spans,
        crossings: &[Crossing],
        (of_joints_m, of_crossings_m): (&[Option<f64>], &[Option<f64>]),
        free_height_m: f64,
    ) -> Self {
        let too_low =
            touching_too_low(spans, crossings, (of_joints_m, of_crossings_m), free_height_m);
        let held = |(number, own_m): (usize, &Option<f64>)| {
            let is_support = spans.joints[number].support.is_some() && !too_low[number];
            own_m.filter(|_| is_support).unwrap_or(f64::NAN)
        };
        let mut finder = Finder {
            held_m: of_joints_m.iter().enumerate().map(held).collect(),
            spans,
            steps: MOST_STEPS + MOST_STEPS_OF_JOINT * spans.joints.len(),
            found: Self { is_refused: too_low, unsolved: Vec::new() },
            waiting: BTreeSet::new(),
            keys: BTreeMap::new(),
        };
        for joint in 0..spans.joints.len() {
            finder.look_at(joint);
        }
        while let Some((.., joint)) = finder.waiting.pop_last() {
            finder.keys.remove(&joint);
            finder.held_m[joint] = f64::NAN;
            finder.found.is_refused[joint] = true;
            let around = finder.around(joint).map(|around| around.supports);
            for other in around.into_iter().flatten() {
                finder.look_at(other);
            }
        }
        finder.found.unsolved.sort_unstable();
        finder.found.unsolved.dedup();
        finder.found
    }
}

/// Returns the joints of spans carried only by touching roads at which the deck would be too low:
/// so near to what it crosses that no road climbs from there to `free_height_m` above it. If this
/// applies to all joints of a span, it applies to none.
///
/// ```text
///   ground ━●━━━━━━━━━━━━━━━●   the deck
///            ╲            ╱ ● this one does not carry it
///             ╲_____ × __╱
/// ```
fn touching_too_low(
    spans: &Spans,
    crossings: &[Crossing],
    (of_joints_m, of_crossings_m): (&[Option<f64>], &[Option<f64>]),
    free_height_m: f64,
) -> Vec<bool> {
    let mut too_low = vec![false; spans.joints.len()];
    for (crossing, ground_m) in crossings.iter().zip(of_crossings_m) {
        let (own, other) = match crossing.lower.kind {
            None => (crossing.upper, crossing.lower),
            Some(_) => (crossing.lower, crossing.upper),
        };
        let edge = spans.edge_of(own.chain).map(|edge| &spans.edges[edge]);
        let (Some(edge), Some(ground_m)) = (edge, *ground_m) else { continue };
        if other.kind.is_some() || crossing.order == Order::Tie {
            continue;
        }
        let ends_m = [own.along_m, edge.length_m - own.along_m];
        for (joint, to_m) in edge.joints.map(|joint| joint as usize).into_iter().zip(ends_m) {
            let is_touching = spans.joints[joint].support == Some(Support::Touching);
            let Some(own_m) = of_joints_m[joint].filter(|_| is_touching) else { continue };
            let missing_m = free_height_m - edge.kind.away() * (own_m - ground_m);
            too_low[joint] |= missing_m > edge.steepest * (to_m - crossing.half_m).max(0.0);
        }
    }
    let mut has_other = vec![false; spans.count];
    for (number, joint) in spans.joints.iter().enumerate() {
        let carries = joint.support.is_some() && of_joints_m[number].is_some() && !too_low[number];
        if let Some(span) = spans.span_of_joint(number).filter(|_| carries) {
            has_other[span] = true;
        }
    }
    for (number, is_too_low) in too_low.iter_mut().enumerate() {
        *is_too_low &= spans.span_of_joint(number).is_some_and(|span| has_other[span]);
    }
    too_low
}

/// The joints around a joint, as far as the next supports.
struct Around {
    /// The joint itself, then the joints that nothing carries.
    free: Vec<usize>,
    supports: Vec<usize>,
    /// The distance to the nearest support, metres.
    nearest_m: f64,
}

impl Finder<'_> {
    /// Decides whether a joint is to be refused.
    fn look_at(&mut self, joint: usize) {
        if let Some(key) = self.keys.remove(&joint) {
            self.waiting.remove(&key);
        }
        if !self.spans.joints[joint].is_passed || self.held_m[joint].is_nan() {
            return;
        }
        let Some(around) = self.around(joint) else {
            self.found.unsolved.push(joint);
            return;
        };
        if around.supports.is_empty() {
            return;
        }
        let off_m = (self.line_m(&around) - self.held_m[joint]).abs();
        let grades = self.spans.edges_of(joint).map(|edge| edge.steepest);
        let steepest = grades.fold(f64::INFINITY, f64::min);
        if off_m > steepest * around.nearest_m + STEP_M {
            let off = (off_m / STEP_M).round() as u64;
            let key = (off, Reverse(self.spans.joints[joint].node), joint);
            self.waiting.insert(key);
            self.keys.insert(joint, key);
        }
    }

    /// Returns the surroundings of a joint; `None` if they are too large.
    fn around(&mut self, joint: usize) -> Option<Around> {
        let mut around =
            Around { free: Vec::new(), supports: Vec::new(), nearest_m: f64::INFINITY };
        let mut known = BTreeSet::new();
        // Distances are not negative, so their bits have the same order as their values.
        let mut waiting = BinaryHeap::from([Reverse((0_u64, joint))]);
        while let Some(Reverse((bits, here))) = waiting.pop() {
            if !known.insert(here) {
                continue;
            }
            self.steps = self.steps.checked_sub(1 + self.spans.edges_at.list(here).len())?;
            if known.len() > MOST_JOINTS {
                return None;
            }
            let to_m = f64::from_bits(bits);
            if here != joint && self.held_m[here].is_finite() {
                around.nearest_m = around.nearest_m.min(to_m);
                around.supports.push(here);
                continue;
            }
            around.free.push(here);
            for (other, length_m) in self.spans.neighbours(here) {
                waiting.push(Reverse(((to_m + length_m).to_bits(), other as usize)));
            }
        }
        Some(around)
    }

    /// Returns the height of the line between the supports around a joint that is not fixed itself;
    /// NaN if it is not solved.
    fn line_m(&self, Around { free, supports, .. }: &Around) -> f64 {
        let all = || free.iter().chain(supports).copied();
        let places: BTreeMap<usize, usize> = all().zip(0..).collect();
        let mut held_m = vec![f64::NAN; free.len()];
        held_m.extend(supports.iter().map(|&joint| self.held_m[joint]));
        let ends = free.iter().flat_map(|&joint| self.spans.edges_at.list(joint));
        let edges: BTreeSet<usize> = ends.map(|end| *end as usize / 2).collect();
        let mut harmonic = Harmonic::new(held_m.len());
        for edge in edges {
            let edge = &self.spans.edges[edge];
            let [from, to] = edge.joints.map(|joint| places.get(&(joint as usize)));
            if let (Some(&from), Some(&to)) = (from, to) {
                harmonic.tie([from, to], edge.length_m);
            }
        }
        harmonic.solve(&held_m).first().copied().unwrap_or(f64::NAN)
    }
}

#[cfg(test)]
#[path = "refusals_tests.rs"]
mod tests;
