//! The extent of the first view of a package: the region of its roads.

use std::collections::BTreeMap;

use corniche_geom::{Bounds, along};
use corniche_roads::FunctionalRoadClass;

use super::{TileGeometry, distance};

/// A rectangle in plan, and the ground in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapExtent {
    /// The rectangle, working metres.
    pub plan: Bounds,
    /// All ground in the rectangle is between these true heights.
    pub heights_m: [f64; 2],
}

/// Maximum share of the roads' length west of the rectangle, and also east, north and south of it:
/// a single road that leads far away does not make the map small.
const TAIL: f64 = 0.01;

/// Width of the margin around the roads, as a share of the longer side of their rectangle.
const MARGIN: f64 = 0.08;

/// Minimum width of a map, as a share of the longer side of the data.
const LEAST_SHARE: f64 = 0.01;

impl MapExtent {
    /// The rectangle of the roads of some tiles, which must be all tiles of a level, with a margin,
    /// within the rectangle of the `data`. `None` if they have no roads. If most of the roads, by
    /// class and length, are in one cluster, the rectangle is that of the cluster.
    ///
    /// A coarse level has only the important roads, simplified. That is enough to locate them.
    #[must_use]
    pub fn of_roads(tiles: &[&TileGeometry], data: Bounds) -> Option<Self> {
        let pieces: Vec<RoadStretch> = tiles.iter().flat_map(|tile| pieces(tile)).collect();
        let pieces = densest_cluster(pieces);
        let [min_x, max_x] = without_tails(&pieces, 0)?;
        let [min_y, max_y] = without_tails(&pieces, 1)?;
        let plan = with_margin(Bounds { min_x, min_y, max_x, max_y }, data);
        Some(Self { plan, heights_m: heights_in(tiles, plan) })
    }

    /// The extent of all `data`, whose ground is between these heights.
    #[must_use]
    pub fn of_data(data: Bounds, heights_m: [f64; 2]) -> Self {
        Self { plan: data, heights_m }
    }
}

/// A piece of a road.
#[derive(Debug, Clone, Copy, PartialEq)]
struct RoadStretch {
    /// Start and end in the working CRS.
    ends: [[f64; 2]; 2],
    class: FunctionalRoadClass,
}

impl RoadStretch {
    fn length_m(&self) -> f64 {
        distance(self.ends[0], self.ends[1])
    }

    /// A point on the piece.
    fn at(&self, share: f64) -> [f64; 2] {
        along(self.ends[0], self.ends[1], share)
    }

    /// Weight of the piece: important roads have a larger weight.
    fn weight(&self) -> f64 {
        self.length_m() * f64::from(FunctionalRoadClass::COUNT as u8 - self.class.number())
    }
}

/// Number of cells along the longer side of the roads' rectangle for finding clusters.
const CELLS: f64 = 64.0;
/// A cluster replaces all roads of a map if it has this share of their weight.
const MOST: f64 = 0.5;

/// The pieces of the cluster with more than half of the weight; all pieces if there is no such
/// cluster. Cells with roads belong to one cluster if they touch, or if only one empty cell is
/// between them.
fn densest_cluster(pieces: Vec<RoadStretch>) -> Vec<RoadStretch> {
    let around = Bounds::around(pieces.iter().flat_map(|piece| &piece.ends));
    let low = [around.min_x, around.min_y];
    let cell_m = around.width().max(around.height()) / CELLS;
    if !(cell_m > 0.0 && cell_m.is_finite()) {
        return pieces;
    }
    let cell = |at: [f64; 2]| [0, 1].map(|axis| ((at[axis] - low[axis]) / cell_m) as i32);
    let mut cells: BTreeMap<[i32; 2], Option<usize>> = BTreeMap::new();
    for piece in &pieces {
        let steps = (2.0 * piece.length_m() / cell_m).ceil().clamp(1.0, 4.0 * CELLS);
        for step in 0..=steps as usize {
            cells.insert(cell(piece.at(step as f64 / steps)), None);
        }
    }
    let mut clusters = 0;
    let all: Vec<[i32; 2]> = cells.keys().copied().collect();
    for first in all {
        let mut waiting = vec![first];
        while let Some([x, y]) = waiting.pop() {
            let Some(own @ None) = cells.get_mut(&[x, y]) else { continue };
            *own = Some(clusters);
            waiting.extend((-2..=2).flat_map(|dx| (-2..=2).map(move |dy| [x + dx, y + dy])));
        }
        clusters += 1;
    }
    let cluster = |piece: &RoadStretch| cells.get(&cell(piece.at(0.0))).copied().flatten();
    let mut weights: BTreeMap<usize, f64> = BTreeMap::new();
    for piece in &pieces {
        if let Some(own) = cluster(piece) {
            *weights.entry(own).or_default() += piece.weight();
        }
    }
    let all: f64 = weights.values().sum();
    let heaviest = weights.iter().max_by(|one, other| one.1.total_cmp(other.1));
    match heaviest {
        Some((&own, &weight)) if weight > MOST * all => {
            pieces.iter().filter(|piece| cluster(piece) == Some(own)).copied().collect()
        }
        _ => pieces,
    }
}

fn pieces(tile: &TileGeometry) -> impl Iterator<Item = RoadStretch> {
    let [x, y, _] = tile.reference_m;
    let on_ground = tile.roads.segments.all().iter().map(|piece| {
        (part_of(piece.start_in_tile, piece.end_in_tile, piece.shares), piece.kind.class)
    });
    let in_plan = tile.roads.volumes.all().iter().map(|volume| {
        (part_of(volume.start_in_tile, volume.end_in_tile, [0.0, 1.0]), volume.kind.class)
    });
    on_ground.chain(in_plan).map(move |(ends, class)| RoadStretch {
        ends: ends.map(|[east, north]| [x + east, y + north]),
        class,
    })
}

/// The range of heights of the tiles' vertices in a rectangle; of all their ground if none is
/// inside.
fn heights_in(tiles: &[&TileGeometry], plan: Bounds) -> [f64; 2] {
    let heights = tiles.iter().flat_map(|tile| {
        let [x, y, height_m] = tile.reference_m;
        tile.ground.vertices.iter().filter_map(move |vertex| {
            let [east, north, above] = vertex.position_in_tile.map(f64::from);
            plan.contains([x + east, y + north]).then_some([height_m + above; 2])
        })
    });
    let all = tiles.iter().filter_map(|tile| tile.summary).map(|ground| ground.height_range_m);
    span(heights).or_else(|| span(all)).unwrap_or_default()
}

/// The union of all ranges.
fn span(ranges: impl Iterator<Item = [f64; 2]>) -> Option<[f64; 2]> {
    ranges.reduce(|[low, high], [next_low, next_high]| [low.min(next_low), high.max(next_high)])
}

/// The ends of a part of a segment.
fn part_of(start: [f32; 2], end: [f32; 2], shares: [f32; 2]) -> [[f64; 2]; 2] {
    let [start, end] = [start, end].map(|point| point.map(f64::from));
    shares.map(|share| along(start, end, f64::from(share)))
}

/// The range of one coordinate without the tails; `None` if the total length is 0.
fn without_tails(pieces: &[RoadStretch], axis: usize) -> Option<[f64; 2]> {
    let mut along: Vec<(f64, f64)> =
        pieces.iter().map(|piece| (piece.at(0.5)[axis], piece.length_m())).collect();
    along.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total_m: f64 = along.iter().map(|(_, length_m)| length_m).sum();
    if total_m <= 0.0 {
        return None;
    }
    let tail_m = TAIL * total_m;
    Some([end_of_tail(along.iter(), tail_m)?, end_of_tail(along.iter().rev(), tail_m)?])
}

/// The coordinate at which this length has been passed.
fn end_of_tail<'a>(mut along: impl Iterator<Item = &'a (f64, f64)>, tail_m: f64) -> Option<f64> {
    let mut passed_m = 0.0;
    along.find_map(|(at, length_m)| {
        passed_m += length_m;
        (passed_m > tail_m).then_some(*at)
    })
}

/// Adds the margin to a rectangle, within the data.
fn with_margin(roads: Bounds, data: Bounds) -> Bounds {
    let least_m = LEAST_SHARE * data.width().max(data.height());
    let margin_m = (MARGIN * roads.width().max(roads.height())).max(least_m / 2.0);
    let wider = roads.expanded([margin_m; 2]).intersection(&data);
    if wider.is_empty() { data } else { wider }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these numbers are exact")]
#[path = "map_extent_tests.rs"]
mod tests;
