//! Solves the heights of free joints between joints with fixed heights.

use std::collections::{BTreeMap, BTreeSet};

/// The maximum number of neighbours of a joint at its elimination; joints with more are not solved.
/// Real spans have a handful, and the time grows with the square.
const MOST_NEIGHBOURS: usize = 256;

/// A network of straight lines between joints.
#[derive(Debug, Default)]
pub(crate) struct Harmonic {
    /// The strength of each joint's ties to others: one over the length between them, added up if
    /// there are several lines.
    ties: Vec<BTreeMap<usize, f64>>,
}

/// An eliminated joint, with its ties to the joints that remained at that time.
struct LeftOut {
    joint: usize,
    ties: BTreeMap<usize, f64>,
}

impl Harmonic {
    /// Creates a network of this many joints.
    pub(crate) fn new(joints: usize) -> Self {
        Self { ties: vec![BTreeMap::new(); joints] }
    }

    /// Adds a line between two joints. A line that returns to its first joint adds no tie.
    pub(crate) fn tie(&mut self, [one, other]: [usize; 2], length_m: f64) {
        if one != other {
            self.add([one, other], 1.0 / length_m.max(1e-3));
        }
    }

    fn add(&mut self, [one, other]: [usize; 2], tie: f64) {
        *self.ties[one].entry(other).or_default() += tie;
        *self.ties[other].entry(one).or_default() += tie;
    }

    /// Returns the height of each joint: fixed heights stay, and at free joints the differences to
    /// the neighbours, each over the length between them, add up to zero. NaN for joints that
    /// depend on no fixed height, and for joints that are too intricate.
    ///
    /// Free joints are eliminated one after the other, those with the fewest neighbours first, and
    /// their neighbours are tied to each other instead. Then, in the opposite order, each joint
    /// gets the mean of its neighbours.
    ///
    /// Source: the star-mesh transform (A. Rosen, *A New Network Theorem*, 1924), which is Gaussian
    /// elimination on a Laplacian.
    pub(crate) fn solve(mut self, held_m: &[f64]) -> Vec<f64> {
        let is_free = |joint: usize| held_m[joint].is_nan();
        let mut order: BTreeSet<(usize, usize)> = (0..self.ties.len())
            .filter(|&joint| is_free(joint))
            .map(|joint| (self.ties[joint].len(), joint))
            .collect();
        let mut left_out = Vec::with_capacity(order.len());
        while let Some((neighbours, joint)) = order.pop_first() {
            if neighbours > MOST_NEIGHBOURS {
                break;
            }
            let ties = std::mem::take(&mut self.ties[joint]);
            let sum: f64 = ties.values().sum();
            let mut change =
                |of: usize,
                 ties: &mut Vec<BTreeMap<usize, f64>>,
                 how: &mut dyn FnMut(&mut BTreeMap<usize, f64>)| {
                    let before = ties[of].len();
                    how(&mut ties[of]);
                    if is_free(of) && ties[of].len() != before {
                        order.remove(&(before, of));
                        order.insert((ties[of].len(), of));
                    }
                };
            for (&one, &to_one) in &ties {
                change(one, &mut self.ties, &mut |own| {
                    own.remove(&joint);
                    for (&other, &to_other) in ties.iter().filter(|(other, _)| **other != one) {
                        *own.entry(other).or_default() += to_one * to_other / sum;
                    }
                });
            }
            left_out.push(LeftOut { joint, ties });
        }
        let mut heights_m = held_m.to_vec();
        for LeftOut { joint, ties } in left_out.into_iter().rev() {
            let sum: f64 = ties.values().sum();
            // If all neighbours have exactly the same height, this joint gets exactly that height.
            let first_m = ties.keys().next().map_or(f64::NAN, |&other| heights_m[other]);
            let above = |(&other, &tie): (&usize, &f64)| tie * (heights_m[other] - first_m);
            heights_m[joint] = first_m + ties.iter().map(above).sum::<f64>() / sum;
        }
        heights_m
    }
}

#[cfg(test)]
#[path = "harmonic_tests.rs"]
mod tests;
