//! The costs of a build's tiles, individually and by subtree.

use std::collections::{BTreeMap, BTreeSet};

use corniche_geom::TileId;

/// Costs of tiles on all levels, in whole microseconds of one core, so that sums do not depend on
/// their order.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TileCosts {
    max_level: u8,
    /// Costs of all tiles that have one, and of the tiles above them.
    by_tile: BTreeMap<TileId, Cost>,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Cost {
    own_us: u64,
    /// Cost including all tiles beneath.
    subtree_us: u64,
    /// Whether it is a finest tile or there is one beneath it.
    has_finest: bool,
}

/// A subtree and its cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Subtree {
    pub id: TileId,
    pub cost_us: u64,
}

impl TileCosts {
    /// Collects the costs of tiles in any order; costs of the same tile are added. No tile is below
    /// `max_level`.
    pub(crate) fn new(max_level: u8, costs: impl IntoIterator<Item = (TileId, u64)>) -> Self {
        let mut by_tile: BTreeMap<TileId, Cost> = BTreeMap::new();
        for (id, cost_us) in costs {
            let cost = by_tile.entry(id).or_default();
            cost.own_us = cost.own_us.saturating_add(cost_us);
            (cost.subtree_us, cost.has_finest) = (cost.own_us, id.z() == max_level);
        }
        for level in (1..=max_level).rev() {
            let of_level = by_tile.iter().filter(|(id, _)| id.z() == level);
            let of_level: Vec<_> = of_level.map(|(&id, &cost)| (id, cost)).collect();
            for (id, Cost { subtree_us, has_finest, .. }) in of_level {
                let above = by_tile.entry(id.ancestor(level - 1)).or_default();
                above.subtree_us = above.subtree_us.saturating_add(subtree_us);
                above.has_finest |= has_finest;
            }
        }
        Self { max_level, by_tile }
    }

    fn cost_at(&self, id: TileId) -> Cost {
        self.by_tile.get(&id).copied().unwrap_or_default()
    }

    /// The cost of all tiles.
    pub(crate) fn total_us(&self) -> u64 {
        self.subtree_us(TileId::ROOT)
    }

    /// The cost of a tile and all tiles beneath it.
    pub(crate) fn subtree_us(&self, id: TileId) -> u64 {
        self.cost_at(id).subtree_us
    }

    /// Returns subtrees that contain every finest tile once. They are the largest ones whose cost
    /// does not exceed `most_us`; only a single finest tile may cost more.
    pub(crate) fn split(&self, most_us: u64) -> Vec<Subtree> {
        let mut found = Vec::new();
        let mut waiting = vec![TileId::ROOT];
        while let Some(id) = waiting.pop() {
            let Cost { subtree_us: cost_us, has_finest, .. } = self.cost_at(id);
            if !has_finest {
                continue;
            }
            if cost_us <= most_us || id.z() == self.max_level {
                found.push(Subtree { id, cost_us });
            } else {
                waiting.extend(id.children());
            }
        }
        found
    }

    /// The cost of all tiles above some subtrees.
    pub(crate) fn above_us(&self, subtrees: &[Subtree]) -> u64 {
        let above = tiles_above(subtrees).into_iter();
        above.map(|id| self.cost_at(id).own_us).fold(0, u64::saturating_add)
    }
}

/// The tiles above some subtrees, each once.
pub(crate) fn tiles_above(subtrees: &[Subtree]) -> BTreeSet<TileId> {
    let above = |subtree: &Subtree| {
        let id = subtree.id;
        (0..id.z()).map(move |level| id.ancestor(level))
    };
    subtrees.iter().flat_map(above).collect()
}

#[cfg(test)]
#[path = "tile_costs_tests.rs"]
mod tests;
