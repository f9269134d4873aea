//! In a level of two by two tiles with voids, every stretch is draped, or counted as without
//! ground, exactly once.

use corniche_geom::{HeightGrid, LatticeBounds, LatticePoint, Polyline};
use corniche_tin::{Placement, Surface, TinSpec, triangulate};
use proptest::prelude::*;

use super::*;
use crate::oracle_tests::off_ground_steps;
use crate::{DrapedLine, clip, clip_closed, drape, positions};

/// Cells along a tile of these tests; each of them represents 256 / 8 cells of a border.
const CELLS: i64 = 8;
/// Lattice steps from node to node.
const STEPS: i64 = 32;
const SIDE: i64 = CELLS * STEPS;
const TILES: i64 = 2;

/// The ground of the whole level: (column, row) of cells from the north-west, 0 to 15.
#[derive(Debug)]
struct Level {
    /// Nodes without a height.
    gaps: Vec<(i64, i64)>,
}

struct Tile {
    bounds: LatticeBounds,
    owned: OwnedBorders,
    surface: Surface,
}

impl Level {
    fn node(&self, column: i64, row: i64) -> bool {
        let inside = |index: i64| (0..=TILES * CELLS).contains(&index);
        inside(column) && inside(row) && !self.gaps.contains(&(column, row))
    }

    fn cell(&self, column: i64, row: i64) -> bool {
        [(0, 0), (1, 0), (0, 1), (1, 1)]
            .iter()
            .all(|&(east, south)| self.node(column + east, row + south))
    }

    /// Creates a tile like the pipeline: from its own window with a halo of one node.
    fn tile(&self, x: i64, y: i64) -> Tile {
        let (west, north) = (x * CELLS, y * CELLS);
        let nodes = CELLS as usize + 3;
        let heights = HeightGrid::from_fn(nodes, nodes, |column, row| {
            let (column, row) = (west + column as i64 - 1, north + row as i64 - 1);
            if self.node(column, row) { (column * 7 % 5 + row * 3 % 4) as f32 } else { f32::NAN }
        });
        let spec = TinSpec { max_error_m: 1.0, quantum_m: 1.0 / 32.0 };
        let tin = triangulate(&heights, spec).unwrap();
        let corner = LatticePoint::new(x * SIDE, -y * SIDE);
        let placement = Placement { corner, node_steps: [STEPS; 2], quantum_m: spec.quantum_m };
        let min = LatticePoint::new(corner.u, corner.v - SIDE);
        let bounds = LatticeBounds { min, max: LatticePoint::new(corner.u + SIDE, corner.v) };
        let here = |cell: i64| cell.div_euclid(TILE_CELLS / CELLS) + 1;
        let owned = OwnedBorders::among(Neighbours { east: x == 0, south: y == 0 }).where_ground(
            |column, row| heights.cell_has_ground(here(column) as usize, here(row) as usize),
        );
        Tile { bounds, owned, surface: Surface::new(&tin, placement) }
    }

    fn tiles(&self) -> Vec<Tile> {
        let places = [(0, 0), (1, 0), (0, 1), (1, 1)];
        places.iter().map(|&(x, y)| self.tile(x, y)).collect()
    }

    /// The stretches of p → q on closed ground cells as fractions of its length, by trying every
    /// cell; merged, in order. f64 is exact enough: positions of different cuts are at least 1 /
    /// 2^20 apart.
    fn on_ground(&self, [p, q]: [LatticePoint; 2]) -> Vec<[f64; 2]> {
        let mut parts = Vec::new();
        for column in 0..TILES * CELLS {
            for row in 0..TILES * CELLS {
                if !self.cell(column, row) {
                    continue;
                }
                let low = [column * STEPS, -(row + 1) * STEPS];
                let (mut from, mut to) = (0.0_f64, 1.0_f64);
                for (low, at, towards) in [(low[0], p.u, q.u), (low[1], p.v, q.v)] {
                    let (low, high) = (low - at, low + STEPS - at);
                    let along = (towards - at) as f64;
                    if towards == at {
                        if low > 0 || high < 0 {
                            to = -1.0;
                        }
                    } else {
                        let (a, b) = (low as f64 / along, high as f64 / along);
                        (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
                    }
                }
                if from + 1e-9 < to {
                    parts.push([from, to]);
                }
            }
        }
        parts.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut merged: Vec<[f64; 2]> = Vec::new();
        for [from, to] in parts {
            match merged.last_mut() {
                Some(last) if from <= last[1] + 1e-9 => last[1] = last[1].max(to),
                _ => merged.push([from, to]),
            }
        }
        merged
    }
}

/// The beginning and the end of a draped part of p → q, in steps from p.
fn span_steps(part: &DrapedLine, surface: &Surface, p: LatticePoint) -> [f64; 2] {
    let at = positions(part, surface).unwrap();
    let reach = |[u, v, _]: [f64; 3]| (u - p.u as f64).hypot(v - p.v as f64);
    [reach(at[0]), reach(at[at.len() - 1])]
}

/// The tolerance for rounding in f64.
const ROUNDING_STEPS: f64 = 1e-6;

/// Checks that one segment is draped on exactly the ground, and nowhere twice. It meets tile
/// borders in lattice points.
fn check_segment(level: &Level, p: LatticePoint, q: LatticePoint) {
    let Ok(line) = Polyline::new(vec![p, q]) else { return };
    let length = p.distance_steps(q);
    let mut laid = Vec::new();
    let (mut kept, mut off) = (0.0, 0.0);
    for tile in level.tiles() {
        for part in clip(&line, &tile.bounds, tile.owned) {
            let draped = drape(&part, &tile.surface);
            off += off_ground_steps(&part, &draped);
            kept += corniche_testing::length_steps(&part);
            laid.extend(draped.lines.iter().map(|part| span_steps(part, &tile.surface, p)));
        }
    }
    laid.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut merged: Vec<[f64; 2]> = Vec::new();
    for [from, to] in laid.iter().copied() {
        match merged.last_mut() {
            Some(last) if from <= last[1] + ROUNDING_STEPS => {
                assert!(last[1] - from <= ROUNDING_STEPS, "laid twice: {laid:?}");
                last[1] = to;
            }
            _ => merged.push([from, to]),
        }
    }
    let expected: Vec<[f64; 2]> =
        level.on_ground([p, q]).iter().map(|part| part.map(|x| x * length)).collect();
    assert_eq!(merged.len(), expected.len(), "laid {merged:?}, ground {expected:?}");
    for (got, want) in merged.iter().flatten().zip(expected.iter().flatten()) {
        assert!((got - want).abs() <= ROUNDING_STEPS, "laid {merged:?}, ground {expected:?}");
    }
    let on: f64 = laid.iter().map(|[from, to]| to - from).sum();
    assert!((on + off - kept).abs() <= ROUNDING_STEPS, "{on} on, {off} off, {kept} in tiles");
    let inside = inside_steps(&line);
    assert!((inside - kept).abs() <= ROUNDING_STEPS, "{inside} inside, {kept} in tiles");
}

/// The length within the level.
fn inside_steps(line: &Polyline) -> f64 {
    let min = LatticePoint::new(0, -TILES * SIDE);
    let root = LatticeBounds { min, max: LatticePoint::new(TILES * SIDE, 0) };
    clip_closed(line, &root).iter().map(corniche_testing::length_steps).sum()
}

/// Difficult coordinates: tile borders, cell borders, and any others; some far outside.
fn coordinate() -> impl Strategy<Value = i64> {
    prop_oneof![
        4 => (0..=TILES).prop_map(|n| n * SIDE),
        3 => (0..=TILES * CELLS).prop_map(|n| n * STEPS),
        2 => -STEPS..TILES * SIDE + STEPS,
        1 => -40 * SIDE..40 * SIDE,
    ]
}

fn any_direction() -> impl Strategy<Value = (i64, i64)> {
    prop_oneof![3 => Just((1, 0)), 3 => Just((0, 1)), 1 => Just((1, 1)), 1 => Just((1, -1)), 1 => Just((2, 1)), 1 => Just((1, -2))]
}

fn any_level() -> impl Strategy<Value = Level> {
    let node = prop_oneof![
        2 => (0..=TILES * CELLS).boxed(),
        // Next to the border in the middle, and on it.
        3 => (CELLS - 1..=CELLS + 1).boxed(),
    ];
    prop::collection::vec((node.clone(), node), 0..14).prop_map(|gaps| Level { gaps })
}

/// The number of cases; each case triangulates a level of four tiles.
const CASES: u32 = 600;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(CASES))]

    /// The tiles of a level drape a segment on all ground along it, each piece once, and count the
    /// rest: nothing is drawn twice, nothing is lost.
    #[test]
    fn tiles_lay_every_piece_exactly_once(
        level in any_level(),
        segments in prop::collection::vec((coordinate(), coordinate(), any_direction(), -200_i64..200), 1..6),
    ) {
        for (u, v, (east, south), reach) in segments {
            // Even coordinates, and directions like a knight's moves, so that borders are met in
            // lattice points.
            let p = LatticePoint::new(u & !1, -(v & !1));
            check_segment(&level, p, LatticePoint::new(p.u + 4 * reach * east, p.v - 4 * reach * south));
        }
    }

    /// Whatever the slopes, no more than the rounding of cuts, half a step each, is lost or gained.
    #[test]
    fn lengths_of_any_line_add_up(
        level in any_level(), points in prop::collection::vec((coordinate(), coordinate()), 2..7),
    ) {
        let points = points.into_iter().map(|(u, v)| LatticePoint::new(u, -v)).collect();
        let Ok(line) = Polyline::new(points) else { return Ok(()) };
        let (mut kept, mut off, mut on) = (0.0, 0.0, 0.0);
        for tile in level.tiles() {
            for part in clip(&line, &tile.bounds, tile.owned) {
                let draped = drape(&part, &tile.surface);
                kept += corniche_testing::length_steps(&part);
                off += off_ground_steps(&part, &draped);
                for at in draped.lines.iter().map(|line| positions(line, &tile.surface)) {
                    on += at.unwrap().windows(2).map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1])).sum::<f64>();
                }
            }
        }
        prop_assert!((on + off - kept).abs() <= 1e-6, "{on} on, {off} off, {kept} in tiles");
        // A segment is cut at six borders at most, at each of them for the tiles on both sides.
        let inside = inside_steps(&line);
        prop_assert!((inside - kept).abs() <= 6.0 * line.points().len() as f64, "{inside} inside, {kept} in tiles");
    }

    /// Lines that are only on tile borders are cut at whole nodes, and add up to the last bit.
    #[test]
    fn lengths_along_borders_add_up_exactly(level in any_level(), [a, b, c] in [coordinate(), coordinate(), coordinate()]) {
        let at = |u: i64, v: i64| LatticePoint::new(u.clamp(0, TILES * SIDE), -v.clamp(0, TILES * SIDE));
        let Ok(line) = Polyline::new(vec![at(SIDE, a), at(SIDE, b), at(SIDE, SIDE), at(c, SIDE)]) else {
            return Ok(());
        };
        let mut sum = 0.0;
        for tile in level.tiles() {
            sum += clip(&line, &tile.bounds, tile.owned).iter().map(corniche_testing::length_steps).sum::<f64>();
        }
        prop_assert_eq!(sum.to_bits(), corniche_testing::length_steps(&line).to_bits());
    }
}

/// Checks what each tile (north-west, north-east, south-west, south-east) keeps of a line: the
/// points of its parts.
#[track_caller]
fn assert_shares(level: &Level, points: &[(i64, i64)], expected: [&[&[(i64, i64)]]; 4]) {
    let points = points.iter().map(|&(u, v)| LatticePoint::new(u * STEPS, -v * STEPS)).collect();
    let line = Polyline::new(points).unwrap();
    for (tile, expected) in level.tiles().iter().zip(expected) {
        let parts = clip(&line, &tile.bounds, tile.owned);
        let nodes = |part: &Polyline| {
            part.points().iter().map(|p| (p.u / STEPS, -p.v / STEPS)).collect::<Vec<_>>()
        };
        assert_eq!(parts.iter().map(nodes).collect::<Vec<_>>(), expected);
    }
}

#[test]
fn a_border_with_ground_on_both_sides_is_the_eastern_tiles() {
    assert_shares(
        &Level { gaps: vec![] },
        &[(8, 2), (8, 6)],
        [&[], &[&[(8, 2), (8, 6)]], &[], &[]],
    );
}

#[test]
fn a_border_with_a_void_in_the_east_is_the_western_tiles_there() {
    // Node (9, 4) is missing, so the eastern tile's cells (8, 3) and (8, 4) are void.
    let level = Level { gaps: vec![(9, 4)] };
    let [down, up] = [[(8, 1), (8, 7)], [(8, 7), (8, 1)]];
    assert_shares(
        &level,
        &down,
        [&[&[(8, 3), (8, 5)]], &[&[(8, 1), (8, 3)], &[(8, 5), (8, 7)]], &[], &[]],
    );
    assert_shares(
        &level,
        &up,
        [&[&[(8, 5), (8, 3)]], &[&[(8, 7), (8, 5)], &[(8, 3), (8, 1)]], &[], &[]],
    );
}

#[test]
fn a_border_with_a_void_in_the_south_is_the_northern_tiles_there() {
    let level = Level { gaps: vec![(4, 9)] };
    assert_shares(
        &level,
        &[(2, 8), (6, 8)],
        [&[&[(3, 8), (5, 8)]], &[], &[&[(2, 8), (3, 8)], &[(5, 8), (6, 8)]], &[]],
    );
}

#[test]
fn a_border_with_voids_on_both_sides_is_counted_by_the_eastern_tile() {
    let level = Level { gaps: vec![(8, 4)] };
    assert_shares(&level, &[(8, 3), (8, 5)], [&[], &[&[(8, 3), (8, 5)]], &[], &[]]);
    let east = level.tile(1, 0);
    let line = Polyline::new(vec![
        LatticePoint::new(SIDE, -3 * STEPS),
        LatticePoint::new(SIDE, -5 * STEPS),
    ]);
    let line = line.unwrap();
    let draped = drape(&line, &east.surface);
    assert_eq!(draped.lines, []);
    assert_eq!(off_ground_steps(&line, &draped).to_bits(), (2.0 * STEPS as f64).to_bits());
}

#[test]
fn the_corner_of_four_tiles_splits_a_line_along_borders() {
    assert_shares(
        &Level { gaps: vec![] },
        &[(8, 4), (8, 12)],
        [&[], &[&[(8, 4), (8, 8)]], &[], &[&[(8, 8), (8, 12)]]],
    );
    // Around the corner: along one border, then along the other.
    assert_shares(
        &Level { gaps: vec![] },
        &[(8, 10), (8, 8), (4, 8)],
        [&[], &[], &[&[(8, 8), (4, 8)]], &[&[(8, 10), (8, 8)]]],
    );
}
