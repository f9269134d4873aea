//! What the tiles of a build cost, alone and as subtrees.

use std::collections::{BTreeMap, BTreeSet};

use corniche_geom::TileId;
use corniche_tileset::pmtiles_order;

/// Costs of tiles on all levels, in whole microseconds of one core: sums do not depend on their order.
///
/// On each level the tiles beneath another one are neighbours along the Hilbert curve, so the cost of a subtree is a difference of two
/// sums on each of its levels.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TileCosts {
    /// Root first; the last one is the finest.
    levels: Vec<LevelCosts>,
}

#[derive(Debug, Clone, PartialEq, Default)]
struct LevelCosts {
    /// Where its tiles lie along the curve of the level, ascending.
    places: Vec<u64>,
    /// The sum of the costs up to each of them.
    sums_us: Vec<u64>,
}

/// A subtree and what it costs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Subtree {
    pub(crate) id: TileId,
    pub(crate) cost_us: u64,
}

impl TileCosts {
    /// Takes the costs of tiles in any order; those of the same tile are added up. No tile is below `max_level`.
    pub(crate) fn new(max_level: u8, costs: impl IntoIterator<Item = (TileId, u64)>) -> Self {
        let mut by_place: Vec<BTreeMap<u64, u64>> =
            vec![BTreeMap::new(); usize::from(max_level) + 1];
        for (id, cost_us) in costs {
            if let Some(level) = by_place.get_mut(usize::from(id.z())) {
                let sum_us = level.entry(place(id)).or_default();
                *sum_us = sum_us.saturating_add(cost_us);
            }
        }
        let levels = by_place.into_iter().map(LevelCosts::new).collect();
        Self { levels }
    }

    /// The cost of all tiles.
    pub(crate) fn total_us(&self) -> u64 {
        self.subtree_us(TileId::ROOT)
    }

    /// The cost of all tiles beneath and at one.
    pub(crate) fn subtree_us(&self, id: TileId) -> u64 {
        let levels = self.levels.iter().enumerate().skip(usize::from(id.z()));
        levels
            .map(|(level, costs)| costs.between_us(ends_beneath(id, level as u8)))
            .fold(0, u64::saturating_add)
    }

    /// Subtrees that hold every finest tile once, none of them more than `most_us` unless it is a finest tile: the largest such.
    pub(crate) fn split(&self, most_us: u64) -> Vec<Subtree> {
        let mut found = Vec::new();
        let mut waiting = vec![TileId::ROOT];
        while let Some(id) = waiting.pop() {
            if !self.has_finest(id) {
                continue;
            }
            let cost_us = self.subtree_us(id);
            if cost_us <= most_us || usize::from(id.z()) + 1 == self.levels.len() {
                found.push(Subtree { id, cost_us });
            } else {
                waiting.extend(id.children());
            }
        }
        found
    }

    /// The cost of all tiles above some subtrees.
    pub(crate) fn above_us(&self, subtrees: &[Subtree]) -> u64 {
        let cost_us = |id: TileId| {
            let costs = self.levels.get(usize::from(id.z()));
            costs.map_or(0, |costs| costs.between_us([place(id), place(id) + 1]))
        };
        tiles_above(subtrees).into_iter().map(cost_us).fold(0, u64::saturating_add)
    }

    fn has_finest(&self, id: TileId) -> bool {
        let finest = self.levels.len().saturating_sub(1);
        self.levels.last().is_some_and(|costs| {
            let [first, end] = ends_beneath(id, finest as u8);
            costs.up_to(first) < costs.up_to(end)
        })
    }
}

impl LevelCosts {
    fn new(by_place: BTreeMap<u64, u64>) -> Self {
        let mut costs = Self::default();
        let mut sum_us = 0_u64;
        for (place, cost_us) in by_place {
            sum_us = sum_us.saturating_add(cost_us);
            costs.places.push(place);
            costs.sums_us.push(sum_us);
        }
        costs
    }

    /// How many tiles lie before a place.
    fn up_to(&self, place: u64) -> usize {
        self.places.partition_point(|&other| other < place)
    }

    /// The cost of the tiles from a place up to another.
    fn between_us(&self, [first, end]: [u64; 2]) -> u64 {
        let sum_us = |count: usize| count.checked_sub(1).map_or(0, |last| self.sums_us[last]);
        sum_us(self.up_to(end)) - sum_us(self.up_to(first))
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

/// Where a tile lies along the curve of its level. PMTiles counts the levels through, root first.
fn place(id: TileId) -> u64 {
    let before = ((1_u64 << (2 * u32::from(id.z()))) - 1) / 3;
    pmtiles_order(id) - before
}

/// Where the tiles of a level beneath a tile begin along the curve, and where they end. The level is not above the tile's.
fn ends_beneath(id: TileId, level: u8) -> [u64; 2] {
    let down = 2 * u32::from(level.saturating_sub(id.z()));
    [place(id) << down, (place(id) + 1) << down]
}

#[cfg(test)]
#[path = "tile_costs_tests.rs"]
mod tests;
