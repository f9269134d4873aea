//! The tiles of a level in which there can be data, as runs of columns.

use std::collections::BTreeMap;

use corniche_geom::{GridFrame, NodeIndex, TILE_CELLS, TileId};

/// The tiles of a level in which there can be data, stored as runs of columns.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct CoveredTiles {
    level: u8,
    /// Row from the north → first and last column of each run, in order and without contact.
    rows: BTreeMap<u32, Vec<[u32; 2]>>,
}

impl CoveredTiles {
    /// The finest tiles that have a cell in one of the rectangles. Each rectangle is given by its
    /// south-western and north-eastern node.
    pub(crate) fn finest(frame: &GridFrame, rectangles: &[[NodeIndex; 2]]) -> Self {
        let size = TILE_CELLS;
        let corner = frame.root_corner();
        let most = (1_i64 << frame.max_level()) - 1;
        // A node on a border belongs to both tiles, but a cell to only one.
        let range = |first: i64, last: i64| {
            let (low, high) = (first.div_euclid(size), (last - 1).max(first).div_euclid(size));
            (low <= most && high >= 0)
                .then(|| [low.clamp(0, most) as u32, high.clamp(0, most) as u32])
        };
        let mut rows: BTreeMap<u32, Vec<[u32; 2]>> = BTreeMap::new();
        for [south_west, north_east] in rectangles {
            let columns = range(south_west.i - corner.i, north_east.i - corner.i);
            let lines = range(corner.j - north_east.j, corner.j - south_west.j);
            let (Some(columns), Some([north, south])) = (columns, lines) else { continue };
            for row in north..=south {
                rows.entry(row).or_default().push(columns);
            }
        }
        Self::new(frame.max_level(), rows)
    }

    /// Merges runs that overlap or touch.
    fn new(level: u8, mut rows: BTreeMap<u32, Vec<[u32; 2]>>) -> Self {
        for runs in rows.values_mut() {
            runs.sort_unstable();
            let mut joined: Vec<[u32; 2]> = Vec::new();
            for &[first, last] in runs.iter() {
                match joined.last_mut() {
                    Some(run) if first <= run[1].saturating_add(1) => run[1] = run[1].max(last),
                    _ => joined.push([first, last]),
                }
            }
            *runs = joined;
        }
        Self { level, rows }
    }

    /// The parents of these tiles; `None` above the root.
    pub(crate) fn parents(&self) -> Option<Self> {
        let level = self.level.checked_sub(1)?;
        let mut rows: BTreeMap<u32, Vec<[u32; 2]>> = BTreeMap::new();
        for (row, runs) in &self.rows {
            let halved = runs.iter().map(|run| run.map(|column| column / 2));
            rows.entry(row / 2).or_default().extend(halved);
        }
        Some(Self::new(level, rows))
    }

    /// The number of these tiles.
    pub(crate) fn count(&self) -> u64 {
        self.rows.values().flatten().map(|[first, last]| u64::from(last - first) + 1).sum()
    }

    /// At most `wanted` of these tiles, spread evenly over all.
    pub(crate) fn spread(&self, wanted: u64) -> Vec<TileId> {
        let count = self.count();
        let picks: Vec<u64> =
            (0..wanted.min(count)).map(|k| (2 * k + 1) * count / (2 * wanted.min(count))).collect();
        let mut before = 0;
        let mut tiles = Vec::new();
        for (&row, runs) in &self.rows {
            for &[first, last] in runs {
                let run = u64::from(last - first) + 1;
                for pick in picks.iter().filter(|pick| (before..before + run).contains(*pick)) {
                    let column = first + (pick - before) as u32;
                    tiles.extend(TileId::new(self.level, column, row).ok());
                }
                before += run;
            }
        }
        tiles
    }
}

#[cfg(test)]
#[path = "covered_tiles_tests.rs"]
mod tests;
