//! Voids through the whole pipeline: there is no spike, no wall and no road in the air, and every
//! node with data that a TIN does not cover is next to a void or the data's edge. Everything is
//! checked by counting nodes and cells of the raster that was written.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

mod counting;
mod degrees;
mod roads;
use crate::support;

use corniche_pipeline::BuildError;
use corniche_testing::some_of;
use counting::{check_ground, filled};
use support::{
    Options, Raster, TILE, build_raster,
    terrain::{bits, noise, waves},
};

const SIDE: usize = 601;
/// The corner of four tiles, and the middle of a border and of a tile: columns and rows of the
/// rasters.
const CORNER: i64 = 300;
const ANCHORS: [[i64; 2]; 3] =
    [[CORNER, CORNER], [CORNER, CORNER + 128], [CORNER - 120, CORNER + 120]];
const MAX_ERROR_M: f64 = 4.0;

/// A hilly raster with voids, the tiles' common corner at [`CORNER`].
fn raster(is_void: &dyn Fn(i64, i64) -> bool) -> Raster {
    Raster::new([SIDE, SIDE], [TILE - CORNER, TILE - CORNER], |column, row| {
        if is_void(column, row) {
            return f32::NAN;
        }
        500.0 + 200.0 * waves(column, row) + 2.0 * noise(column, row)
    })
}

/// Builds and compares with the counted values.
fn check(name: &str, is_void: &dyn Fn(i64, i64) -> bool, fill_voids: u32) {
    let raster = raster(is_void);
    let options = Options { fill_voids, ..Options::plain(MAX_ERROR_M) };
    let built = build_raster(&raster, options).unwrap_or_else(|error| panic!("{name}: {error}"));
    check_ground(name, &built, &filled(&raster, i64::from(fill_voids)), &raster);
}

/// Whether a node is in a square of `side` nodes around an anchor.
fn in_square([column, row]: [i64; 2], [east, south]: [i64; 2], side: i64) -> bool {
    let from = side / 2;
    (0..side).contains(&(column - east + from)) && (0..side).contains(&(row - south + from))
}

#[test]
fn holes_of_every_size_on_corners_borders_and_inside() {
    for side in some_of([1, 65, 2, 17, 3], [3, 2, 1]) {
        let hole = |c, r| ANCHORS.iter().any(|&anchor| in_square([c, r], anchor, side));
        check(&format!("holes of {side}"), &hole, 0);
        check(&format!("holes of {side}, filled within 8"), &hole, 8);
    }
}

#[test]
fn islands_of_every_size_on_corners_borders_and_inside() {
    for side in [2, 3, 17, 65] {
        let sea = |c, r| !ANCHORS.iter().any(|&anchor| in_square([c, r], anchor, side));
        check(&format!("islands of {side}"), &sea, 0);
        check(&format!("islands of {side}, filled within 8"), &sea, 8);
    }
    // A single node has no ground; next to an island it is allowed.
    let rock = |c, r| !(in_square([c, r], ANCHORS[0], 9) || [c, r] == ANCHORS[1]);
    check("a rock next to an island", &rock, 0);
}

#[test]
#[ignore = "slow: ten builds of six tiles"]
fn holes_and_islands_as_large_as_tiles() {
    for side in [255, 256, 257, 258, 400] {
        // Squares from the corner of tiles to the east and south: a whole tile, one node less, one
        // more.
        let square =
            |c: i64, r: i64| (0..side).contains(&(c - CORNER)) && (0..side).contains(&(r - CORNER));
        check(&format!("a hole of {side}"), &square, 8);
        check(&format!("an island of {side}"), &|c, r| !square(c, r), 0);
    }
}

#[test]
#[ignore = "slow: fourteen builds of six tiles"]
fn checkerboards_stripes_and_scattered_nodes() {
    for side in [2, 3, 7, 128] {
        let board = |c: i64, r: i64| (c / side + r / side) % 2 == 0;
        check(&format!("a board of {side}"), &board, 0);
        check(&format!("a board of {side}, filled within 5"), &board, 5);
    }
    check("single columns void", &|c, _| c % 16 == 12, 0);
    check("pairs of columns with data", &|c, _| c % 3 == 2, 0);
    check("every column of a border void", &|c, _| c == CORNER, 0);
    check("all but two columns next to a border void", &|c, _| c != CORNER && c != CORNER + 1, 0);
    check("scattered", &|c, r| bits(c, r, 1).is_multiple_of(50), 0);
    check("scattered, filled within 3", &|c, r| bits(c, r, 1).is_multiple_of(3), 3);
}

#[test]
fn data_that_end_across_the_grid() {
    for angle_deg in [45.0_f64, 17.0, 1.5] {
        let (sin, cos) = angle_deg.to_radians().sin_cos();
        let outside = |c: i64, r: i64| {
            let (x, y) = ((c - CORNER) as f64, (r - CORNER) as f64);
            (x * cos + y * sin).abs() > 200.0 || (y * cos - x * sin).abs() > 190.0
        };
        check(&format!("a square turned by {angle_deg}"), &outside, 0);
        check(&format!("a square turned by {angle_deg}, filled within 32"), &outside, 32);
    }
    let disc = |c: i64, r: i64| (c - CORNER).pow(2) + (r - CORNER).pow(2) > 280 * 280;
    check("a disc", &disc, 32);
}

/// Every second node is void: there is no data along the diagonals through a void, so none is
/// filled, and no cell is complete.
#[test]
fn a_board_of_single_nodes_has_no_ground() {
    for fill_voids in [0, 32] {
        let raster = raster(&|c, r| (c + r) % 2 == 0);
        let options = Options { fill_voids, ..Options::plain(MAX_ERROR_M) };
        let refused = build_raster(&raster, options).err().unwrap();
        let data = (SIDE * SIDE / 2) as u64;
        assert!(matches!(refused, BuildError::NoCell { nodes, .. } if nodes == data), "{refused}");
        assert!(
            refused.is_unusable_input() && refused.to_string().contains("dem.tif"),
            "{refused}"
        );
    }
    let refused = build_raster(&raster(&|_, _| true), Options::plain(MAX_ERROR_M)).err().unwrap();
    assert!(matches!(refused, BuildError::NoHeights { .. }), "{refused}");
}
