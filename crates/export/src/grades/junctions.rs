//! One height for each junction: a local fit over all its legs.
//!
//! ```text
//!            │ c            The two straightest legs, a and b, form one smooth line through the junction. Other legs, c, are lines that end
//!     a ─────●───── b       there. Each line gives a height of the junction and a weight; the chosen height has the least total cost.
//! ```
//!
//! Lines reach as far as the smoothing does, through other junctions along the straightest legs
//! there. In this module, a node is a node of the network.

use corniche_geom::IndexLists;
use corniche_work::Observer;

use super::smoothing::{MOST_SPACING_M, Smoothing};
use crate::error::ElevationError;

/// Two legs continue each other if the road turns by less than this between them, as a cosine: 45°.
const STRAIGHT: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// At a node with more legs, no leg continues another. No real junction has as many, and pairs are
/// compared two by two.
const MOST_LEGS: usize = 64;
/// The number of chains that a line may pass, so that the work is bounded where chains are very
/// short.
const MOST_CHAINS: usize = 64;

/// One end of a chain, seen from its node.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct Leg {
    pub(crate) chain: usize,
    /// Whether the node is at the chain's last station.
    pub(crate) is_last: bool,
}

impl Leg {
    fn from_end(end: usize) -> Self {
        Self { chain: end / 2, is_last: end % 2 == 1 }
    }

    fn end(self) -> usize {
        2 * self.chain + usize::from(self.is_last)
    }

    /// The other end of the same chain.
    fn other(self) -> Self {
        Self { is_last: !self.is_last, ..self }
    }
}

/// The legs of all nodes, with heights of the ground along them.
pub(crate) trait Legs {
    /// The ends of chains at each node: twice the number of the chain, plus one for its last
    /// station.
    fn by_node(&self) -> IndexLists;
    /// Whether a node needs no height of its own: at a dead end, and at the start of a ring without
    /// a junction.
    fn is_alone(&self, node: usize) -> bool;
    /// The strength of the smoothing.
    fn smoothing(&self) -> Smoothing;
    /// The distance between stations, and the ground at them from the node onwards; NaN where there
    /// is none.
    fn leg(&self, leg: Leg) -> (f64, Box<dyn Iterator<Item = f32> + '_>);
    /// The direction in which a leg leaves its node: of length 1, or 0 if the leg has none.
    fn direction(&self, leg: Leg) -> [f64; 2];
}

/// Marks a leg that no other leg continues.
const NONE: u32 = u32::MAX;

/// Returns the height of each node; NaN if it has no leg with ground, or needs none.
pub(crate) fn node_heights(
    legs: &dyn Legs,
    observer: &dyn Observer,
) -> Result<Vec<f64>, ElevationError> {
    let by_node = legs.by_node();
    let nodes = by_node.parts()[0].len() - 1;
    let goes_on_in = goes_on_in(legs, &by_node);
    let smoothing = legs.smoothing();
    let mut heights_m = vec![f64::NAN; nodes];
    for (node, height_m) in heights_m.iter_mut().enumerate() {
        if node % 4096 == 0 {
            observer.check()?;
        }
        if legs.is_alone(node) {
            continue;
        }
        let (mut sum, mut weights) = (0.0, 0.0);
        for &end in by_node.list(node) {
            let leg = Leg::from_end(end as usize);
            let partner = goes_on_in[leg.end()];
            if partner != NONE && partner < end {
                // The leg and its partner are one line.
                continue;
            }
            let mut line = outwards(legs, leg, &goes_on_in);
            let mut at = 0;
            if partner != NONE {
                let other = outwards(legs, Leg::from_end(partner as usize), &goes_on_in);
                at = other.len().max(1) - 1;
                line = other.into_iter().rev().chain(line.into_iter().skip(1)).collect();
            }
            if line.is_empty() {
                continue;
            }
            let found = smoothing.estimate(MOST_SPACING_M, &line, at);
            sum += found.weight * found.height_m;
            weights += found.weight;
        }
        if weights > 0.0 {
            *height_m = sum / weights;
        }
    }
    Ok(heights_m)
}

/// Returns, for each end of a chain, the end of another chain at the same node that continues it
/// most straight.
fn goes_on_in(legs: &dyn Legs, by_node: &IndexLists) -> Vec<u32> {
    let nodes = by_node.parts()[0].len() - 1;
    let ends = by_node.parts()[1].iter().max().map_or(0, |most| *most as usize + 2);
    let mut partners = vec![NONE; ends];
    let mut pairs: Vec<(f64, u32, u32)> = Vec::new();
    for node in 0..nodes {
        let own = by_node.list(node);
        if own.len() > MOST_LEGS {
            continue;
        }
        let directions: Vec<[f64; 2]> =
            own.iter().map(|&end| legs.direction(Leg::from_end(end as usize))).collect();
        pairs.clear();
        for (k, (&one, a)) in own.iter().zip(&directions).enumerate() {
            for (&other, b) in own.iter().zip(&directions).skip(k + 1) {
                let straight = -(a[0] * b[0] + a[1] * b[1]);
                if straight > STRAIGHT {
                    pairs.push((straight, one, other));
                }
            }
        }
        pairs.sort_by(|one, other| other.0.total_cmp(&one.0));
        for &(_, one, other) in &pairs {
            if partners[one as usize] == NONE && partners[other as usize] == NONE {
                (partners[one as usize], partners[other as usize]) = (other, one);
            }
        }
    }
    partners
}

/// Returns the ground along a leg and the legs that continue it, every ten metres from its node, as
/// far as the smoothing reaches; empty if the node has no ground.
fn outwards(legs: &dyn Legs, first: Leg, goes_on_in: &[u32]) -> Vec<f64> {
    let reach_m = legs.smoothing().length_m;
    let mut heights_m: Vec<f64> = Vec::new();
    let mut leg = first;
    // The distance along the line at which the chain begins.
    let mut begin_m = 0.0;
    for _ in 0..MOST_CHAINS {
        let (spacing_m, stations) = legs.leg(leg);
        let mut before: Option<f64> = None;
        let mut along_m = begin_m;
        for ground_m in stations.map(f64::from) {
            if !ground_m.is_finite() {
                return heights_m;
            }
            if let Some(before_m) = before.replace(ground_m) {
                let from_m = along_m;
                along_m += spacing_m;
                while heights_m.len() as f64 * MOST_SPACING_M <= along_m {
                    let wanted_m = heights_m.len() as f64 * MOST_SPACING_M;
                    if wanted_m > reach_m {
                        return heights_m;
                    }
                    let share = ((wanted_m - from_m) / spacing_m).clamp(0.0, 1.0);
                    heights_m.push(before_m + share * (ground_m - before_m));
                }
            } else if heights_m.is_empty() {
                heights_m.push(ground_m);
            }
        }
        let next = goes_on_in.get(leg.other().end()).copied().unwrap_or(NONE);
        if next == NONE {
            break;
        }
        begin_m = along_m;
        leg = Leg::from_end(next as usize);
    }
    heights_m
}

#[cfg(test)]
#[path = "junctions_tests.rs"]
mod tests;
