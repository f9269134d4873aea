//! What a first view of a package shows: where its roads are.

use std::collections::BTreeMap;

use corniche_geom::{Bounds, along};
use corniche_roads::FunctionalRoadClass;

use super::{TileGeometry, distance};

/// A rectangle in plan, and the ground in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapExtent {
    /// The rectangle, working metres.
    pub plan: Bounds,
    /// All ground in it lies between these true heights.
    pub heights_m: [f64; 2],
}

/// So much of the roads' length may lie west of the rectangle, and as much east, north and south of it: a single road that
/// leads far away does not make the map small.
const TAIL: f64 = 0.01;

/// Width of the margin around the roads, as a share of the longer side of their rectangle.
const MARGIN: f64 = 0.08;

/// A map is at least so wide: a share of the longer side of the data.
const LEAST_SHARE: f64 = 0.01;

impl MapExtent {
    /// The rectangle of the roads of some tiles, which are all of a level, with a margin, within the rectangle of the `data`.
    /// `None` if there are no roads on them. Where most of the roads, by class and length, lie in one cluster, it is that of the cluster.
    ///
    /// A coarse level has the important roads alone, simplified. That is enough to tell where they are.
    #[must_use]
    pub fn of_roads(tiles: &[&TileGeometry], data: Bounds) -> Option<Self> {
        let pieces: Vec<Piece> = tiles.iter().flat_map(|tile| pieces(tile)).collect();
        let pieces = densest_cluster(pieces);
        let [min_x, max_x] = without_tails(&pieces, 0)?;
        let [min_y, max_y] = without_tails(&pieces, 1)?;
        let plan = with_margin(Bounds { min_x, min_y, max_x, max_y }, data);
        Some(Self { plan, heights_m: heights_in(tiles, plan) })
    }

    /// All of the `data`, whose ground lies between these heights.
    #[must_use]
    pub fn of_data(data: Bounds, heights_m: [f64; 2]) -> Self {
        Self { plan: data, heights_m }
    }
}

/// A piece of a road.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    /// Where it begins and ends in the working CRS.
    ends: [[f64; 2]; 2],
    class: FunctionalRoadClass,
}

impl Piece {
    fn length_m(&self) -> f64 {
        distance(self.ends[0], self.ends[1])
    }

    /// A place on it.
    fn at(&self, share: f64) -> [f64; 2] {
        along(self.ends[0], self.ends[1], share)
    }

    /// How much it counts: important roads count more.
    fn weight(&self) -> f64 {
        self.length_m() * f64::from(FunctionalRoadClass::COUNT as u8 - self.class.number())
    }
}

/// Roads are sought in so many cells along the longer side of their rectangle.
const CELLS: f64 = 64.0;
/// A cluster is all roads of a map if it has this share of their weight.
const MOST: f64 = 0.5;

/// The pieces of the cluster that has most of them; all pieces, if none has. Cells with roads are of one cluster if they touch, or if one empty
/// cell lies between them.
fn densest_cluster(pieces: Vec<Piece>) -> Vec<Piece> {
    let ends = || pieces.iter().flat_map(|piece| piece.ends);
    let bounds =
        ends().fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], |[low, high], at| {
            [0, 1].map(|side| {
                [0, 1].map(|axis| {
                    if side == 0 { low[axis].min(at[axis]) } else { high[axis].max(at[axis]) }
                })
            })
        });
    let [low, high] = bounds;
    let cell_m = (high[0] - low[0]).max(high[1] - low[1]) / CELLS;
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
    let cluster = |piece: &Piece| cells.get(&cell(piece.at(0.0))).copied().flatten();
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

fn pieces(tile: &TileGeometry) -> impl Iterator<Item = Piece> {
    let [x, y, _] = tile.reference_m;
    let on_ground = tile.roads.all().iter().map(|piece| {
        (part_of(piece.start_in_tile, piece.end_in_tile, piece.shares), piece.kind.class)
    });
    let in_plan = tile.volumes.all().iter().map(|volume| {
        (part_of(volume.start_in_tile, volume.end_in_tile, [0.0, 1.0]), volume.kind.class)
    });
    on_ground.chain(in_plan).map(move |(ends, class)| Piece {
        ends: ends.map(|[east, north]| [x + east, y + north]),
        class,
    })
}

/// The heights of the ground in a rectangle, as far as the vertices of tiles tell; of all their ground if none is there.
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

/// What all these ranges lie in.
fn span(ranges: impl Iterator<Item = [f64; 2]>) -> Option<[f64; 2]> {
    ranges.reduce(|[low, high], [next_low, next_high]| [low.min(next_low), high.max(next_high)])
}

/// The ends of a part of a segment.
fn part_of(start: [f32; 2], end: [f32; 2], shares: [f32; 2]) -> [[f64; 2]; 2] {
    let [start, end] = [start, end].map(|point| point.map(f64::from));
    shares
        .map(|share| [0, 1].map(|axis| start[axis] + f64::from(share) * (end[axis] - start[axis])))
}

/// The range of one coordinate without the tails; `None` without any length.
fn without_tails(pieces: &[Piece], axis: usize) -> Option<[f64; 2]> {
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

/// Where so much length has been passed.
fn end_of_tail<'a>(mut along: impl Iterator<Item = &'a (f64, f64)>, tail_m: f64) -> Option<f64> {
    let mut passed_m = 0.0;
    along.find_map(|(at, length_m)| {
        passed_m += length_m;
        (passed_m > tail_m).then_some(*at)
    })
}

/// A rectangle with its margin, within the data.
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
