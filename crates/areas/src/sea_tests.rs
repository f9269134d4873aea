//! Everything that is not land is sea, also where coastlines are open or contradict each other.

use std::collections::BTreeSet;

use corniche_geom::LatticeBounds;
use proptest::prelude::*;

use super::*;
use crate::OutlineWay;
use crate::chessboard_tests::random;

fn coast(way_id: i64, points: &[(i64, i64)]) -> Coastline {
    Coastline { way_id, points: points.iter().map(|&(u, v)| LatticePoint::new(u, v)).collect() }
}

/// Returns a rectangle that is 100 wide and 60 high.
fn bounds() -> Vec<Polygon> {
    rectangle([0, 0, 100, 60])
}

fn rectangle([west, south, east, north]: [i64; 4]) -> Vec<Polygon> {
    let [min, max] = [LatticePoint::new(west, south), LatticePoint::new(east, north)];
    Polygon::rectangle(LatticeBounds { min, max }).into_iter().collect()
}

/// Returns the polygons that rings enclose by the even-odd rule.
fn region(rings: &[&[(i64, i64)]]) -> Vec<Polygon> {
    let closed = |ring: &&[(i64, i64)]| {
        let points = ring.iter().chain(ring.first());
        points.map(|&(u, v)| LatticePoint::new(u, v)).collect::<Vec<_>>()
    };
    let rings: Vec<Vec<LatticePoint>> = rings.iter().map(closed).collect();
    let ways: Vec<OutlineWay<'_>> = rings.iter().map(|points| OutlineWay { points }).collect();
    assemble(&ways).unwrap().polygons
}

fn area(sea: &Sea) -> i128 {
    sea.polygons.iter().map(Polygon::doubled_area).sum::<i128>() / 2
}

fn sea_of(coastlines: Vec<Coastline>) -> Sea {
    close_sea(coastlines, &bounds()).unwrap()
}

#[test]
fn sea_lies_on_the_right() {
    let northward = sea_of(vec![coast(1, &[(30, -5), (30, 70)])]);
    assert_eq!((area(&northward), northward.polygons.len()), (70 * 60, 1));
    let southward = sea_of(vec![coast(1, &[(30, 70), (30, -5)])]);
    assert_eq!(area(&southward), 30 * 60);
    assert!(southward.bridged.is_empty() && southward.left_out.is_empty());
}

#[test]
fn islands_and_inner_seas() {
    let island: &[(i64, i64)] = &[(10, 10), (20, 10), (20, 20), (10, 20), (10, 10)];
    let pond: Vec<(i64, i64)> = island.iter().rev().copied().collect();
    assert_eq!(area(&sea_of(vec![coast(1, island)])), 6000 - 100);
    assert_eq!(area(&sea_of(vec![coast(1, &pond)])), 100);
    // There is an island near a coast, and one whose outline leaves the rectangle.
    let both = vec![coast(1, &[(30, 70), (30, -5)]), coast(2, island)];
    assert_eq!(area(&sea_of(both)), 30 * 60 - 100);
    let half = coast(3, &[(-10, 10), (10, 10), (10, 30), (-10, 30), (-10, 10)]);
    assert_eq!(area(&sea_of(vec![half])), 6000 - 200);
    // Without coasts nothing is known.
    assert_eq!(sea_of(vec![]), Sea::default());
    assert_eq!(sea_of(vec![coast(1, &[(300, 0), (300, 50)])]), Sea::default());
}

#[test]
fn a_strait_between_two_coasts() {
    let coasts = vec![coast(1, &[(30, -5), (30, 70)]), coast(2, &[(60, 70), (60, -5)])];
    assert_eq!(area(&sea_of(coasts.clone())), 30 * 60);
    let land_between: Vec<Coastline> = coasts
        .into_iter()
        .map(|mut coast| {
            coast.points.reverse();
            coast
        })
        .collect();
    assert_eq!(area(&sea_of(land_between)), 70 * 60);
}

#[test]
fn open_ends_are_bridged_and_told() {
    // The gap is five steps wide; the edge is farther away.
    let gap = vec![coast(1, &[(50, -5), (50, 28)]), coast(2, &[(50, 33), (50, 70)])];
    let sea = sea_of(gap);
    assert_eq!((area(&sea), &sea.bridged[..]), (50 * 60, &[1, 2][..]));
    // An end with nothing near it continues to the edge.
    let sea = sea_of(vec![coast(8, &[(50, -5), (50, 50)])]);
    assert_eq!((area(&sea), &sea.bridged[..]), (50 * 60, &[8][..]));
    // The ring has a gap.
    let sea = sea_of(vec![coast(3, &[(40, 30), (50, 30), (50, 38), (40, 38), (40, 31)])]);
    assert_eq!((area(&sea), &sea.bridged[..]), (6000 - 80, &[3][..]));
}

#[test]
fn coasts_that_contradict_each_other_are_left_out_and_told() {
    // Both coasts go north: between them, the first claims sea and the second claims land.
    let coasts = vec![coast(1, &[(30, -5), (30, 70)]), coast(2, &[(60, -500), (60, -5), (60, 70)])];
    let sea = sea_of(coasts);
    assert_eq!(sea.left_out.len(), 1);
    assert!([40 * 60, 70 * 60].contains(&area(&sea)), "{sea:?}");
    let crossing = vec![coast(1, &[(30, -5), (60, 70)]), coast(2, &[(60, -5), (31, 70)])];
    let crossing = close_sea(crossing, &bounds());
    assert!(crossing.is_err() || !crossing.unwrap().left_out.is_empty());
}

/// Coasts are closed along the edge of the known region, whatever its shape.
#[test]
fn regions_that_are_no_rectangles() {
    let southward = || vec![coast(1, &[(30, 70), (30, -5)])];
    // The northwest is not known.
    let corner = region(&[&[(0, 0), (100, 0), (100, 60), (20, 60), (20, 40), (0, 40)]]);
    let sea = close_sea(southward(), &corner).unwrap();
    assert_eq!((area(&sea), sea.bridged.len()), (30 * 60 - 20 * 20, 0));
    // Two separate regions are known.
    let apart =
        region(&[&[(0, 0), (50, 0), (50, 20), (0, 20)], &[(10, 40), (60, 40), (60, 60), (10, 60)]]);
    assert_eq!(area(&close_sea(southward(), &apart).unwrap()), 30 * 20 + 20 * 20);
    // The known region has a hole on the coast.
    let hole = region(&[
        &[(0, 0), (100, 0), (100, 60), (0, 60)],
        &[(20, 20), (40, 20), (40, 30), (20, 30)],
    ]);
    assert_eq!(area(&close_sea(southward(), &hole).unwrap()), 30 * 60 - 100);
    // There is an island in a diamond, and one that extends beyond the diamond's edge.
    let diamond = || region(&[&[(0, -500), (500, 0), (0, 500), (-500, 0)]]);
    let island = coast(1, &[(0, 0), (10, 0), (10, 10), (0, 10), (0, 0)]);
    assert_eq!(area(&close_sea(vec![island], &diamond()).unwrap()), 500_000 - 100);
    let cape = coast(2, &[(600, -100), (600, 100), (300, 100), (300, -100), (600, -100)]);
    assert_eq!(area(&close_sea(vec![cape], &diamond()).unwrap()), 500_000 - 30_000);
}

/// The region is a rotated square across a coast: points are rounded where its sides are cut, and
/// no end counts as open.
#[test]
fn slanting_edges_are_met_between_steps() {
    let turned = || region(&[&[(-970, -333), (333, -970), (970, 333), (-333, 970)]]);
    let (mut found, mut count) = (0, 0);
    for tilt in -40..40 {
        let line = coast(1, &[(-2000, 13 * tilt - 7), (2000, -11 * tilt + 5)]);
        let mut back = line.clone();
        back.points.reverse();
        let both = [line, back].map(|coast| close_sea(vec![coast], &turned()).unwrap());
        assert!(both.iter().all(|sea| sea.bridged.is_empty() && sea.left_out.is_empty()));
        found += both.iter().map(area).sum::<i128>();
        count += 1;
    }
    let whole = 970 * 970 * 2 + 333 * 333 * 2;
    assert!((found - count * whole).abs() < count * 3000, "{found} {}", count * whole);
}

/// The steps along a cell of the random sea.
const CELL: i64 = 10;

/// Returns coasts around cells of land at random places in a field of 9 × 9 cells. The field
/// surrounds a rectangle that ends within cells.
fn coasts_around(land: &BTreeSet<(i64, i64)>, seed: u64) -> Vec<Coastline> {
    let mut edges = Vec::new();
    for &(x, y) in land {
        let corner = |dx: i64, dy: i64| LatticePoint::new((x + dx) * CELL, (y + dy) * CELL);
        // The direction is counter-clockwise around the cell, so that land is on the left.
        for (beside, edge) in [
            ((x, y - 1), [corner(0, 0), corner(1, 0)]),
            ((x + 1, y), [corner(1, 0), corner(1, 1)]),
            ((x, y + 1), [corner(1, 1), corner(0, 1)]),
            ((x - 1, y), [corner(0, 1), corner(0, 0)]),
        ] {
            if !land.contains(&beside) {
                edges.push(edge);
            }
        }
    }
    let mut random = random(seed);
    let mut coasts = Vec::new();
    while !edges.is_empty() {
        let [from, to] = edges.swap_remove(random(edges.len()));
        let mut points = vec![from, to];
        while random(4) != 0
            && let Some(next) = edges.iter().position(|edge| Some(&edge[0]) == points.last())
        {
            points.push(edges.swap_remove(next)[1]);
        }
        coasts.push(Coastline { way_id: coasts.len() as i64, points });
    }
    coasts
}

proptest! {
    #[test]
    fn the_sea_is_what_is_no_land(
        land in prop::collection::btree_set((0_i64..9, 0_i64..9), 1..60),
        seed in 1_u64..,
    ) {
        let sea = close_sea(coasts_around(&land, seed), &rectangle([13, 14, 77, 76])).unwrap();
        prop_assert!(sea.bridged.is_empty() && sea.left_out.is_empty());
        let mut expected = 0;
        let (mut has_land, mut has_coast) = (false, false);
        for u in 13..77 {
            for v in 14..76 {
                let is_land = land.contains(&(u / CELL, v / CELL));
                expected += i128::from(!is_land);
                has_land |= is_land;
                has_coast |= !is_land;
            }
        }
        // Without a coast in the rectangle, nothing is known.
        if has_land && has_coast {
            prop_assert_eq!(area(&sea), expected);
        } else {
            prop_assert_eq!(area(&sea), 0);
        }
    }
}
