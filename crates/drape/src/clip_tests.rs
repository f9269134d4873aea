//! The tiles together contain each line once, in agreement with brute force.

use std::collections::BTreeMap;

use super::*;
use crate::Neighbours;
use corniche_geom::TileId;
use proptest::prelude::*;

fn point(u: i64, v: i64) -> LatticePoint {
    LatticePoint::new(u, v)
}

fn line(points: &[(i64, i64)]) -> Polyline {
    Polyline::new(points.iter().map(|&(u, v)| point(u, v)).collect()).unwrap()
}

/// The side of the tiles of these tests.
const SIDE: i64 = 10;
const TILES: i64 = 3;

/// The bounds and the borders of a tile in a column from the west and a row from the north; the
/// root's north-west corner is (0, 0).
fn tile(column: i64, row: i64) -> (LatticeBounds, OwnedBorders) {
    let min = point(column * SIDE, -(row + 1) * SIDE);
    let bounds = LatticeBounds { min, max: point(min.u + SIDE, min.v + SIDE) };
    (bounds, OwnedBorders::among(Neighbours { east: column < TILES - 1, south: row < TILES - 1 }))
}

/// Returns the tile to which the middle of a piece belongs, from positions in `parts` of a step.
fn owner(u: i128, v: i128, parts: i128) -> Option<(i64, i64)> {
    let span = i128::from(SIDE) * parts;
    let last = i128::from(TILES) * span;
    if u < 0 || u > last || v > 0 || v < -last {
        return None;
    }
    let index = |offset: i128| offset.div_euclid(span).min(i128::from(TILES) - 1) as i64;
    Some((index(u), index(-v)))
}

/// Computes all cuts of a segment by all tile borders, sorted; each piece goes to the tile that
/// owns its middle.
fn expected(line: &Polyline, column: i64, row: i64) -> Vec<Polyline> {
    let mut parts: Vec<Vec<LatticePoint>> = Vec::new();
    let mut open = false;
    for pair in line.points().windows(2) {
        let (p, q) = (pair[0], pair[1]);
        let (du, dv) = (i128::from(q.u - p.u), i128::from(q.v - p.v));
        // Positions along the segment are multiples of 1 / (2 |du| |dv|), which is exact for every
        // cut and every middle.
        let whole = 2 * du.abs().max(1) * dv.abs().max(1);
        let mut cuts = vec![0, whole];
        for border in (-TILES..=TILES).map(|n| i128::from(n * SIDE)) {
            for (from, d) in [(p.u, du), (p.v, dv)] {
                if d != 0 {
                    let cut = (border - i128::from(from)) * whole / d;
                    if 0 < cut && cut < whole {
                        cuts.push(cut);
                    }
                }
            }
        }
        cuts.sort_unstable();
        cuts.dedup();
        let round = |from: i64, d: i128, cut: i128| {
            from + (2 * d * cut + whole).div_euclid(2 * whole) as i64
        };
        let at = |cut: i128| point(round(p.u, du, cut), round(p.v, dv, cut));
        let mut inside_before = false;
        for pair in cuts.windows(2) {
            let middle = pair[0] + pair[1];
            let (u, v) = (
                i128::from(p.u) * 2 * whole + du * middle,
                i128::from(p.v) * 2 * whole + dv * middle,
            );
            let inside = owner(u, v, 2 * whole) == Some((column, row));
            if inside && inside_before {
                // A border elsewhere cuts nothing here.
                *parts.last_mut().unwrap().last_mut().unwrap() = at(pair[1]);
            } else if inside {
                if !(open && pair[0] == 0) {
                    parts.push(vec![at(pair[0])]);
                }
                parts.last_mut().unwrap().push(at(pair[1]));
            }
            inside_before = inside;
        }
        open = inside_before;
    }
    parts.into_iter().filter_map(|points| Polyline::new(points).ok()).collect()
}

/// Points around nine tiles, often on their borders and corners, sometimes far away.
fn any_line() -> impl Strategy<Value = Polyline> {
    let number = || prop_oneof![4 => -5_i64..35, 3 => (0_i64..=3).prop_map(|n| n * SIDE), 1 => -4000_i64..4000];
    prop::collection::vec((number(), number().prop_map(|v| -v)), 2..8)
        .prop_filter_map("a point", |points| {
            Polyline::new(points.into_iter().map(|(u, v)| point(u, v)).collect()).ok()
        })
}

/// For each segment of the whole line, the length along its longer side that a part covers. Cuts
/// are rounded along the other side, or to the same point from both sides.
fn covered(part: &ClippedPart) -> Vec<(usize, i64)> {
    let pairs = part.line.points().windows(2).zip(&part.segments);
    pairs
        .map(|(pair, &segment)| (segment, (pair[1].u - pair[0].u) + 1000 * (pair[1].v - pair[0].v)))
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    /// Every tile gets the same pieces as by cutting at all borders by brute force: the whole line,
    /// each piece once.
    #[test]
    fn tiles_share_a_line_as_brute_force_does(line in any_line()) {
        for column in 0..TILES {
            for row in 0..TILES {
                let (bounds, owned) = tile(column, row);
                let parts = clip(&line, &bounds, owned);
                prop_assert_eq!(&parts, &expected(&line, column, row), "tile {} {}", column, row);
                for part in &parts {
                    prop_assert!(part.points().iter().all(|&p| bounds.contains(p)));
                }
            }
        }
    }

    /// Parts in a second rectangle equal those of clipping to both rectangles at once: cuts depend
    /// only on the segment.
    #[test]
    fn within_bounds_cuts_are_those_of_whole_segments(
        line in any_line(), west in 0_i64..28, south in 0_i64..28, size in (1_i64..12, 1_i64..12),
    ) {
        let min = point(west, south - 30);
        let within = LatticeBounds { min, max: point(min.u + size.0, min.v + size.1) };
        let root = LatticeBounds { min: point(0, -TILES * SIDE), max: point(TILES * SIDE, 0) };
        let mut of_tiles = BTreeMap::new();
        for column in 0..TILES {
            for row in 0..TILES {
                let (bounds, owned) = tile(column, row);
                let both = bounds.intersection(&within);
                if both.min.u < both.max.u && both.min.v < both.max.v {
                    let found = clip_parts_within(&line, &bounds, OwnedBorders::ALL, &within);
                    prop_assert_eq!(found, clip_parts(&line, &both, OwnedBorders::ALL));
                }
                let parts = clip_parts_within(&line, &bounds, owned, &within);
                for (segment, steps) in parts.iter().flat_map(covered) {
                    *of_tiles.entry(segment).or_insert(0) += steps;
                }
                if within.contains(bounds.min) && within.contains(bounds.max) {
                    prop_assert_eq!(parts, clip_parts(&line, &bounds, owned));
                }
            }
        }
        // No piece is lost, and none is in two tiles.
        let mut whole = BTreeMap::new();
        let parts = clip_parts(&line, &root.intersection(&within), OwnedBorders::ALL);
        for (segment, steps) in parts.iter().flat_map(covered) {
            *whole.entry(segment).or_insert(0) += steps;
        }
        prop_assert_eq!(of_tiles, whole);
    }

    /// No point of a part is farther than half a step from the segment from which it was cut.
    #[test]
    fn a_part_stays_within_half_a_step_of_its_source(line in any_line()) {
        let (bounds, owned) = tile(1, 1);
        for part in clip(&line, &bounds, owned) {
            for &at in part.points() {
                let near = |p: LatticePoint, q: LatticePoint| {
                    let (du, dv) = (q.u - p.u, q.v - p.v);
                    let (across, along) = (du * (at.v - p.v) - dv * (at.u - p.u), du * (at.u - p.u) + dv * (at.v - p.v));
                    let length_squared = du * du + dv * dv;
                    // Half a step along a border is less than that across a segment, and less than
                    // one step along it.
                    4 * across * across <= length_squared && (-length_squared..=2 * length_squared).contains(&along)
                };
                prop_assert!(line.points().windows(2).any(|pair| near(pair[0], pair[1])), "{at:?}");
            }
        }
    }

    /// The reversed line has the same parts, reversed.
    #[test]
    fn direction_does_not_matter(line in any_line(), scale in prop_oneof![Just(1_i64), Just(1 << 40)]) {
        let scaled = |p: &LatticePoint| point(p.u * scale + 1, p.v * scale - 1);
        let there = Polyline::new(line.points().iter().map(scaled).collect()).unwrap();
        let back = Polyline::new(there.points().iter().rev().copied().collect()).unwrap();
        let (bounds, owned) = tile(1, 1);
        let bounds = LatticeBounds {
            min: point(bounds.min.u * scale, bounds.min.v * scale),
            max: point(bounds.max.u * scale, bounds.max.v * scale),
        };
        let turn = |part: &Polyline| part.points().iter().rev().copied().collect::<Vec<_>>();
        let there: Vec<_> = clip(&there, &bounds, owned).iter().rev().map(turn).collect();
        let back: Vec<_> = clip(&back, &bounds, owned).into_iter().map(Polyline::into_points).collect();
        prop_assert_eq!(there, back);
    }
}

#[test]
fn a_segment_on_a_shared_border_is_in_one_tile() {
    let along = line(&[(10, -12), (10, -18)]);
    let (west, east) = (tile(0, 1), tile(1, 1));
    assert_eq!(clip(&along, &west.0, west.1), []);
    assert_eq!(clip(&along, &east.0, east.1), [along]);
    let along = line(&[(12, -10), (18, -10)]);
    let (north, south) = (tile(1, 0), tile(1, 1));
    assert_eq!(clip(&along, &north.0, north.1), []);
    assert_eq!(clip(&along, &south.0, south.1), [along]);
}

#[test]
fn the_edge_of_the_root_is_kept() {
    let along = line(&[(30, -22), (30, -30), (22, -30)]);
    let (bounds, owned) = tile(2, 2);
    assert_eq!(clip(&along, &bounds, owned), [along]);
    let id = |x, y| TileId::new(2, x, y).unwrap();
    assert_eq!(OwnedBorders::of_tile(id(3, 3)), OwnedBorders::ALL);
    assert_eq!(
        OwnedBorders::of_tile(id(0, 3)),
        OwnedBorders::among(Neighbours { east: true, south: false })
    );
}

#[test]
fn touching_the_border_at_a_point_leaves_nothing() {
    let bounds = tile(1, 1).0;
    assert_eq!(clip_closed(&line(&[(5, -15), (10, -15), (5, -18)]), &bounds), []);
    assert_eq!(
        clip_closed(&line(&[(5, -15), (15, -5)]), &bounds),
        [],
        "through the corner (10, -10)"
    );
}

#[test]
fn a_line_far_longer_than_the_tile_is_cut_exactly() {
    let far = (1 << 60) - 2;
    let bounds = tile(1, 1).0;
    let parts = clip_closed(&line(&[(-far, -15), (far, -15)]), &bounds);
    assert_eq!(parts, [line(&[(10, -15), (20, -15)])]);
    let parts = clip_closed(&line(&[(-far, far - 2), (far, -far - 2)]), &bounds);
    assert_eq!(parts, [line(&[(10, -12), (18, -20)])]);
}
