//! Continues bridges of several ways in one another, off the ground.

use std::collections::HashMap;

use corniche_geom::LatticePoint;

use super::stretches::PlanStretch;
use crate::plane::steps_between;

/// Turns whose directions have a larger product count as turning back: 120°.
const SHARPEST_TURN: f64 = 0.5;

/// The ends of decks by place, each with the point before it.
pub(crate) struct DeckEnds {
    inner: HashMap<LatticePoint, Vec<LatticePoint>>,
}

impl DeckEnds {
    /// Returns the ends of the decks among some stretches.
    pub(crate) fn from_stretches<'a>(stretches: impl Iterator<Item = &'a PlanStretch>) -> Self {
        let mut inner: HashMap<LatticePoint, Vec<LatticePoint>> = HashMap::new();
        for stretch in stretches.filter(|stretch| stretch.deck_m.is_some()) {
            for (end, next) in stretch.ends().into_iter().zip(stretch.next_to_ends()) {
                inner.entry(end).or_default().push(next);
            }
        }
        Self { inner }
    }

    /// Returns the next point beyond an end of a deck, 0 or 1, on the deck that continues it most
    /// straight. Slabs of both then end in the same line across, unless their widths differ.
    pub(crate) fn beyond(&self, deck: &PlanStretch, end: usize) -> Option<LatticePoint> {
        let (at, own) = (deck.ends()[end], deck.next_to_ends()[end]);
        let direction = |to: LatticePoint| {
            let [du, dv] = steps_between(at, to);
            let length = du.hypot(dv);
            [du / length, dv / length]
        };
        let [east, north] = direction(own);
        let product = |to: &LatticePoint| {
            let [du, dv] = direction(*to);
            east * du + north * dv
        };
        let others = self.inner.get(&at)?.iter().filter(|other| **other != own);
        let straightest = others.min_by(|one, other| {
            product(one).total_cmp(&product(other)).then_with(|| one.cmp(other))
        })?;
        (product(straightest) < SHARPEST_TURN).then_some(*straightest)
    }
}

#[cfg(test)]
#[path = "deck_ends_tests.rs"]
mod tests;
