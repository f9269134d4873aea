//! The check of reliefs finds a changed height, gap or slope.

#![allow(clippy::unwrap_used, reason = "helpers of tests may unwrap")]

use corniche_geom::Cell;

use super::*;

const CELL: Cell = Cell { east_m: 20.0, north_m: 30.0 };

fn raster(height_m: impl Fn(f64, f64) -> f64) -> HeightGrid {
    HeightGrid::from_fn(TILE_NODES + 2, TILE_NODES + 2, |column, row| {
        height_m(column as f64, row as f64) as f32
    })
}

fn hills(east: f64, south: f64) -> f64 {
    300.0 + 50.0 * (east / 19.0).sin() * (south / 27.0).sin()
}

/// Whether this is the given node of the raster.
fn is(east: f64, south: f64, node: [i64; 2]) -> bool {
    [east as i64, south as i64] == node
}

/// The number of findings if the relief of one raster is compared with another raster.
fn broken(of: &HeightGrid, beside: &HeightGrid) -> u64 {
    let relief = Relief::of_heights(of, of, CELL, 0.125).unwrap();
    let mut findings = Findings::default();
    let slope_at = |at: [usize; 2]| corniche_tin::gradient(beside, at, CELL);
    verify(TileId::ROOT, &relief, (beside, [0.0; 2]), slope_at, &mut findings);
    findings.check_mut(CheckId::Relief).broken
}

#[test]
fn another_height_gap_or_slope_is_found() {
    let sound = raster(hills);
    assert_eq!(broken(&sound, &sound), 0);
    // One node is off by far more than the greatest error.
    let node = raster(|e, s| hills(e, s) + if is(e, s, [90, 70]) { 30.0 } else { 0.0 });
    assert_eq!(broken(&sound, &node), 1);
    let gap = raster(|e, s| if is(e, s, [90, 70]) { f64::NAN } else { hills(e, s) });
    assert_eq!(broken(&sound, &gap), 1);
    // Only a slope on the border: the changed height is in the halo.
    let halo = raster(|e, s| hills(e, s) + if is(e, s, [0, 70]) { 1.0 } else { 0.0 });
    assert_eq!(broken(&sound, &halo), 1);
}

#[test]
fn borders_are_the_same_on_both_sides_and_only_there() {
    let last = (TILE_NODES - 1) as f64;
    let of = |left: f64| {
        let raster = raster(|e, s| hills(e + left, s));
        Relief::of_heights(&raster, &raster, CELL, 0.125).unwrap()
    };
    let ([_, _, west, east], [_, _, next_west, next_east]) =
        (borders(&of(0.0)), borders(&of(last)));
    assert_eq!(east, next_west);
    assert_ne!(west, next_west);
    assert_ne!(east, next_east);
}
