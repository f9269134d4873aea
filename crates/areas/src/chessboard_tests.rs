//! Random areas for tests: cells of a chessboard.

use std::collections::BTreeSet;

use corniche_geom::LatticePoint;
use geo::{Coord, LineString};
use proptest::prelude::*;

use crate::{Polygon, Ring};

/// Generates the cells of a chessboard that are inside.
pub(crate) fn cells() -> impl Strategy<Value = BTreeSet<(i64, i64)>> {
    prop::collection::btree_set((0_i64..9, 0_i64..9), 1..60)
}

/// Returns the borders between inner and outer cells as ways, which are cut and turned at random;
/// the bits of `seed` decide.
pub(crate) fn ways_around(cells: &BTreeSet<(i64, i64)>, seed: u64) -> Vec<Vec<LatticePoint>> {
    let mut edges: Vec<[(i64, i64); 2]> = Vec::new();
    for &(x, y) in cells {
        for (beside, edge) in [
            ((x, y - 1), [(x, y), (x + 1, y)]),
            ((x, y + 1), [(x, y + 1), (x + 1, y + 1)]),
            ((x - 1, y), [(x, y), (x, y + 1)]),
            ((x + 1, y), [(x + 1, y), (x + 1, y + 1)]),
        ] {
            if !cells.contains(&beside) {
                edges.push(edge);
            }
        }
    }
    let mut random = random(seed);
    let mut ways = Vec::new();
    while !edges.is_empty() {
        let [mut from, to] = edges.swap_remove(random(edges.len()));
        if random(2) == 0 {
            ways.push(vec![from, to]);
            continue;
        }
        let mut way = vec![from, to];
        from = to;
        while let Some(next) = edges.iter().position(|edge| edge.contains(&from)) {
            if random(5) == 0 {
                break;
            }
            let edge = edges.swap_remove(next);
            from = if edge[0] == from { edge[1] } else { edge[0] };
            way.push(from);
        }
        ways.push(way);
    }
    ways.into_iter().map(|way| way.into_iter().map(placed).collect()).collect()
}

/// Returns a generator of numbers below a given one (Marsaglia 2003, *Xorshift RNGs*).
pub(crate) fn random(mut seed: u64) -> impl FnMut(usize) -> usize {
    move |below: usize| {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed % below as u64) as usize
    }
}

/// Returns the corner of a cell at a position where no side is horizontal or vertical.
pub(crate) fn placed((x, y): (i64, i64)) -> LatticePoint {
    LatticePoint::new(7 * x - 2 * y, 3 * x + 11 * y)
}

/// The doubled area of a cell with those corners.
pub(crate) const DOUBLED_CELL: i128 = 2 * (7 * 11 + 2 * 3);

/// Returns the number of groups of cells that are connected by their sides.
pub(crate) fn groups(cells: &BTreeSet<(i64, i64)>) -> usize {
    let mut left = cells.clone();
    let mut groups = 0;
    while let Some(first) = left.pop_first() {
        groups += 1;
        let mut waiting = vec![first];
        while let Some((x, y)) = waiting.pop() {
            let beside = [(x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)];
            waiting.extend(beside.into_iter().filter(|cell| left.remove(cell)));
        }
    }
    groups
}

pub(crate) fn to_geo(polygon: &Polygon) -> geo::Polygon<f64> {
    let line = |ring: &Ring| {
        let coords =
            ring.points().iter().map(|point| Coord { x: point.u as f64, y: point.v as f64 });
        LineString::from(coords.collect::<Vec<_>>())
    };
    geo::Polygon::new(line(polygon.outer()), polygon.holes().iter().map(line).collect())
}

/// Returns the polygons of some cells.
pub(crate) fn polygons_around(cells: &BTreeSet<(i64, i64)>) -> Vec<Polygon> {
    let ways = ways_around(cells, 1);
    let ways: Vec<_> = ways.iter().map(|points| crate::OutlineWay { points }).collect();
    crate::assemble(&ways).unwrap().polygons
}
