//! Border cells derived from TINs equal those derived from the heights from which the TINs were
//! created.

use std::collections::BTreeMap;

use corniche_dem::{Dem, OpenOptions, PlanOptions};
use corniche_geom::{HeightGrid, TileId};
use corniche_tin::{TinSpec, triangulate};
use proptest::prelude::*;

use super::*;

/// Nodes along a side of a tile with one node of halo at both ends.
const HALO_NODES: usize = TILE_CELLS as usize + 3;

/// Compares the borders that each tile owns, derived in both ways from its heights with halo.
fn check(heights: &dyn Fn(i64, i64) -> Option<HeightGrid>, [columns, rows]: [i64; 2]) -> usize {
    let spec = TinSpec { max_error_m: 4.0, quantum_m: 1.0 / 32.0 };
    // All tiles together with their neighbours.
    let all: BTreeMap<[i64; 2], HeightGrid> = (-1..=rows)
        .flat_map(|y| (-1..=columns).map(move |x| [x, y]))
        .filter_map(|[x, y]| Some(([x, y], heights(x, y)?)))
        .collect();
    let cells = |x, y| match all.get(&[x, y]) {
        Some(heights) => BorderCells::from_tin(&triangulate(heights, spec).unwrap()),
        None => BorderCells::default(),
    };
    let mut partly = 0;
    for (x, y) in (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))) {
        let around = CellsAround {
            own: cells(x, y),
            north: cells(x, y - 1),
            east: cells(x + 1, y),
            south: cells(x, y + 1),
            west: cells(x - 1, y),
        };
        for neighbours in [(false, false), (true, false), (false, true), (true, true)]
            .map(|(east, south)| Neighbours { east, south })
        {
            let by_heights = OwnedBorders::among(neighbours).where_ground(|column, row| {
                all.get(&[x, y]).is_some_and(|heights| {
                    heights.cell_has_ground((column + 1) as usize, (row + 1) as usize)
                })
            });
            assert_eq!(around.owned(neighbours), by_heights, "tile {x}, {y} {neighbours:?}");
            partly += usize::from(by_heights != OwnedBorders::among(neighbours));
        }
    }
    partly
}

/// The heights of a tile in a level of tiles in which `is_void` marks the nodes without height.
fn of_tile(is_void: &dyn Fn(i64, i64) -> bool, x: i64, y: i64) -> Option<HeightGrid> {
    let heights = HeightGrid::from_fn(HALO_NODES, HALO_NODES, |column, row| {
        let (column, row) = (x * TILE_CELLS + column as i64 - 1, y * TILE_CELLS + row as i64 - 1);
        if is_void(column, row) {
            f32::NAN
        } else {
            500.0 + 90.0 * ((column as f32) * 0.05).sin() * ((row as f32) * 0.07).cos()
        }
    });
    (heights.count_heights() > 0).then_some(heights)
}

/// Whether a node is a void.
type IsVoid = Box<dyn Fn(i64, i64) -> bool>;

#[test]
fn voids_along_borders_and_on_corners_are_seen_by_both_sides() {
    let last = 2 * TILE_CELLS;
    let outside = move |c: i64, r: i64| !(0..=last).contains(&c) || !(0..=last).contains(&r);
    let border = |at: i64| (TILE_CELLS - 1..=TILE_CELLS + 1).contains(&at);
    let voids: [(&str, IsVoid); 6] = [
        ("the data's edge alone", Box::new(outside)),
        ("single nodes on borders", Box::new(move |c, r| outside(c, r) || border(c) && r % 7 == 0)),
        (
            "next to the borders",
            Box::new(move |c, r| outside(c, r) || (c == TILE_CELLS + 1 && r % 9 < 4)),
        ),
        ("the corner", Box::new(move |c, r| outside(c, r) || border(c) && border(r))),
        ("one tile", Box::new(move |c, r| outside(c, r) || c > TILE_CELLS && r > TILE_CELLS)),
        ("diagonals", Box::new(move |c, r| outside(c, r) || (c + r) % 5 == 0)),
    ];
    for (name, is_void) in &voids {
        let partly = check(&|x, y| of_tile(is_void, x, y), [2, 2]);
        assert!(partly > 0, "{name}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// Nodes are void at random: few, half of them, or nearly all.
    #[test]
    fn random_voids(seed: u64, share in prop_oneof![Just(3_u64), Just(50), Just(300)]) {
        let is_void = move |column: i64, row: i64| {
            let node = (column as u64) << 32 ^ (row as u64 & 0xffff_ffff);
            let mixed = (node ^ seed).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            (mixed ^ mixed >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 32 & 511 < share
        };
        prop_assert!(check(&|x, y| of_tile(&is_void, x, y), [2, 1]) > 0);
    }
}

/// The sample, whose data end within tiles, and the sample with all heights of some ranges treated
/// as nodata.
#[test]
fn the_sample_with_and_without_voids() {
    let path = corniche_testing::sample("pass/pass-dem.tif");
    let options = |fill_voids| PlanOptions { fill_voids, ..PlanOptions::default() };
    let dem = Dem::open(&[path], &OpenOptions::default()).unwrap();
    let plan = dem.plan(&options(0)).unwrap();
    let (frame, level) = (plan.frame, plan.frame.max_level());
    let side = 1 << level;
    for is_holey in [false, true] {
        let heights = |x: i64, y: i64| {
            let id = TileId::new(level, u32::try_from(x).ok()?, u32::try_from(y).ok()?).ok()?;
            let window = dem.reader(&plan).window(frame.tile_window(id).with_halo(1)).unwrap();
            let own = window.heights;
            let heights = HeightGrid::from_fn(HALO_NODES, HALO_NODES, |column, row| {
                let height_m = own.height(column, row).unwrap_or(f32::NAN);
                if is_holey && (height_m * 0.1) as i64 % 4 == 0 { f32::NAN } else { height_m }
            });
            (heights.count_heights() > 0).then_some(heights)
        };
        let partly = check(&heights, [side, side]);
        // The data end within tiles, so without voids both sides of every border are equal.
        assert!(partly > 20 || !is_holey, "{partly}");
    }
}
