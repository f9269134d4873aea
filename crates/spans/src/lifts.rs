//! How far decks are lifted, and tunnels lowered, so that crossing roads keep their order.
//!
//! ```text
//!                  ╱╲
//!     ●━━━━━━━━━━━╱━━╲━━━━━━●
//!     support      crossing
//! ```
//!
//! Each lift is a *tent*: it is highest at the crossing and comes down to zero at the nearest
//! support, and at the same distance along all other chains.

use std::{
    cmp::Reverse,
    collections::{BTreeMap, BinaryHeap, btree_map::Entry},
};

use crate::spans::Spans;

/// The maximum number of joints that a tent may cover. Real spans have some hundred at most, so all
/// of their lifts could cover all of their joints.
const MOST_JOINTS: usize = 1024;
/// The maximum number of tents on one edge; no real edge needs a tenth.
const MOST_TENTS: usize = 256;

/// The part of a tent that is on one edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tent {
    apex_m: f64,
    /// The distance at which the tent has come down to zero.
    reach_m: f64,
    /// The distances of the apex from the ends of the edge.
    from_ends_m: [f64; 2],
    /// The stretch of the edge where the tent is highest, from and to, metres; `None` if the apex
    /// is elsewhere.
    apex_at: Option<[f64; 2]>,
}

impl Tent {
    /// Returns the height of the tent at a distance along its edge.
    pub(crate) fn height_m(&self, along_m: f64, length_m: f64) -> f64 {
        let [first_m, last_m] = self.from_ends_m;
        let around_m = (first_m + along_m).min(last_m + length_m - along_m);
        let direct_m = self.apex_at.map_or(f64::INFINITY, |[from_m, to_m]| {
            (from_m - along_m).max(along_m - to_m).max(0.0)
        });
        self.apex_m * (1.0 - around_m.min(direct_m) / self.reach_m).max(0.0)
    }

    /// Whether this is a lower tent over the same place than another one.
    pub(crate) fn is_below(&self, other: &Self) -> bool {
        let place = |tent: &Self| {
            (tent.from_ends_m.map(f64::to_bits), tent.apex_at.map(|at| at.map(f64::to_bits)))
        };
        place(self) == place(other) && self.apex_m < other.apex_m
    }

    /// Returns the distances along the edge at which the tent bends.
    pub(crate) fn bends_m(&self, length_m: f64) -> impl Iterator<Item = f64> + use<> {
        let [first_m, last_m] = self.from_ends_m;
        let feet_m = [self.reach_m - first_m, length_m - (self.reach_m - last_m)];
        let valley_m = (length_m + last_m - first_m) / 2.0;
        let reach_m = self.reach_m;
        let own = self
            .apex_at
            .into_iter()
            .flat_map(move |[from_m, to_m]| [from_m - reach_m, from_m, to_m, to_m + reach_m]);
        feet_m
            .into_iter()
            .chain([valley_m])
            .chain(own)
            .filter(move |&at_m| at_m > 0.0 && at_m < length_m)
    }
}

/// A position on an edge.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OnEdge {
    pub edge: usize,
    pub along_m: f64,
}

/// The distances of joints from a stretch of an edge, up to the nearest support.
pub(crate) struct Reach {
    edge: usize,
    /// The start and the end of the stretch along the edge, metres.
    stretch_m: [f64; 2],
    /// The distance of the nearest support.
    pub support_m: f64,
    /// The joints that are nearer, with their distances.
    joints: BTreeMap<u32, f64>,
}

impl Reach {
    /// Searches along edges from a position, and from the stretch around it, until it reaches a
    /// support; `None` if there is none within [`MOST_JOINTS`].
    pub(crate) fn around(
        spans: &Spans,
        held: &dyn Fn(usize) -> bool,
        (at, half_m): (OnEdge, f64),
    ) -> Option<Self> {
        let mut joints = BTreeMap::new();
        // Distances are not negative, so their bits have the same order as their values.
        let mut waiting = BinaryHeap::new();
        let edge = &spans.edges[at.edge];
        let stretch_m = [at.along_m - half_m, at.along_m + half_m];
        let ends_m = [stretch_m[0], edge.length_m - stretch_m[1]].map(|to_m| to_m.max(0.0));
        for (joint, to_m) in edge.joints.into_iter().zip(ends_m) {
            waiting.push(Reverse((to_m.to_bits(), joint)));
        }
        while let Some(Reverse((bits, joint))) = waiting.pop() {
            if joints.len() > MOST_JOINTS {
                break;
            }
            let to_m = f64::from_bits(bits);
            if held(joint as usize) {
                return Some(Self { edge: at.edge, stretch_m, support_m: to_m, joints });
            }
            match joints.entry(joint) {
                Entry::Occupied(_) => continue,
                Entry::Vacant(entry) => entry.insert(to_m),
            };
            for (other, length_m) in spans.neighbours(joint as usize) {
                waiting.push(Reverse(((to_m + length_m).to_bits(), other)));
            }
        }
        None
    }

    /// Returns the tents on edges within reach if the apex has this height, with the numbers of the
    /// edges.
    pub(crate) fn tents(&self, spans: &Spans, apex_m: f64) -> Vec<(usize, Tent)> {
        let to_m = |joint: u32| self.joints.get(&joint).copied().unwrap_or(self.support_m);
        let mut edges: Vec<usize> = vec![self.edge];
        for &joint in self.joints.keys() {
            edges.extend(spans.edges_at.list(joint as usize).iter().map(|end| *end as usize / 2));
        }
        edges.sort_unstable();
        edges.dedup();
        let tent = |edge: usize| Tent {
            apex_m,
            reach_m: self.support_m,
            from_ends_m: spans.edges[edge].joints.map(to_m),
            apex_at: (edge == self.edge).then_some(self.stretch_m),
        };
        edges.into_iter().map(|edge| (edge, tent(edge))).collect()
    }
}

/// Adds tents, all or none: without some of them a deck would be torn at its joints. Returns
/// whether they were added, which requires that there is space for all of them.
pub(crate) fn put_up(tents: &mut [Vec<Tent>], all: Vec<(usize, Tent)>) -> bool {
    if all.iter().any(|(edge, _)| tents[*edge].len() >= MOST_TENTS) {
        return false;
    }
    for (edge, tent) in all {
        // A tent over the same place replaces the one that was too low.
        tents[edge].retain(|other| !other.is_below(&tent));
        tents[edge].push(tent);
    }
    true
}
