//! Both sides of a tile border agree to the last bit, and errors are those that CesiumJS assumes.

#![expect(clippy::float_cmp, reason = "the test checks equality to the last bit")]

use proptest::prelude::*;

use super::*;

const BOTH: [Tiling; 2] = [Tiling::Geographic, Tiling::WebMercator];

/// The values of CesiumJS 1.145 for its two grids, divided by two at each level.
#[test]
fn errors_are_those_that_cesium_assumes() {
    let near = |error_m: f64, known_m: f64| (error_m - known_m).abs() < 1e-3;
    assert!(near(Tiling::Geographic.level_error_m(0), 77_067.340));
    assert!(near(Tiling::WebMercator.level_error_m(0), 154_134.680));
    assert!(near(Tiling::Geographic.level_error_m(14), 77_067.340 / 16_384.0));
}

#[test]
fn edges_of_the_globe() {
    assert_eq!(Tiling::Geographic.roots().count(), 2);
    assert_eq!(Tiling::WebMercator.roots().count(), 1);
    assert_eq!(Tiling::Geographic.lat_deg(3, 0), -90.0);
    assert_eq!(Tiling::Geographic.lat_deg(3, 8), 90.0);
    // The latitude at which Mercator's square ends: gd(π).
    assert!((Tiling::WebMercator.lat_deg(0, 1) - 85.051_128_779_806_6).abs() < 1e-12);
    for tiling in BOTH {
        assert_eq!(tiling.lon_deg(5, 0), -180.0);
        assert_eq!(tiling.lon_deg(5, tiling.columns(5)), 180.0);
        assert_eq!(tiling.row_of(4, 90.0), 15);
        assert_eq!(tiling.row_of(4, -90.0), 0);
    }
}

proptest! {
    /// A place is between the edges of its column and row.
    #[test]
    fn places_lie_in_their_tile(lon in -180.0..180.0_f64, lat in -85.0..85.0_f64, level in 0_u8..20) {
        for tiling in BOTH {
            let (x, y) = (tiling.column_of(level, lon), tiling.row_of(level, lat));
            prop_assert!(tiling.lon_deg(level, x) <= lon + 1e-9 && lon <= tiling.lon_deg(level, x + 1) + 1e-9);
            prop_assert!(tiling.lat_deg(level, y) <= lat + 1e-9 && lat <= tiling.lat_deg(level, y + 1) + 1e-9);
        }
    }

    /// Both tiles at a border have it at the same place, to the last bit, at every u or v.
    #[test]
    fn borders_are_the_same_from_both_sides(
        level in 1_u8..16, x in 0_u32..100_000, y in 0_u32..100_000, step in 0..=LAST_STEP,
        per_tile in prop::sample::select(vec![16_i64, 64, 256]),
    ) {
        for tiling in BOTH {
            let nodes = RasterNodes { tiling, level, per_tile, parts: 4 };
            let columns = tiling.columns(level) as u32;
            let rows = Tiling::rows(level) as u32;
            let tile = TerrainTile { z: level, x: x % columns, y: y % (rows - 1) };
            let east = TerrainTile { x: (tile.x + 1) % columns, ..tile };
            let north = TerrainTile { y: tile.y + 1, ..tile };
            prop_assert_eq!(nodes.place_deg(tile, [LAST_STEP, step]), nodes.place_deg(east, [0, step]));
            prop_assert_eq!(nodes.place_deg(tile, [step, LAST_STEP]), nodes.place_deg(north, [step, 0]));
        }
    }

    /// u and v of a place are recovered, and their cell contains them.
    #[test]
    fn steps_are_found_again(u in 1..LAST_STEP, v in 1..LAST_STEP, x in 0_u32..16, y in 0_u32..8) {
        for tiling in BOTH {
            let nodes = RasterNodes { tiling, level: 4, per_tile: 64, parts: 4 };
            let tile = TerrainTile { z: 4, x: x % tiling.columns(4) as u32, y };
            let square = nodes.square_of(tile);
            let found = square.uv_of(nodes.place_deg(tile, [u, v]));
            prop_assert_eq!(found.map(|step| step.round() as u16), [u, v]);
            let again = square.uv_of(square.place_deg(found));
            prop_assert!((0..2).all(|axis| (again[axis] - found[axis]).abs() < 1e-6));
            let cell = nodes.cell_of(u);
            prop_assert!(nodes.step(cell) <= u && u <= nodes.step(cell + 1));
        }
    }
}

#[test]
fn borders_are_looked_at_from_end_to_end() {
    for (per_tile, parts) in [(16, 32), (64, 5), (256, 8)] {
        let nodes = RasterNodes { tiling: Tiling::Geographic, level: 9, per_tile, parts };
        let steps = nodes.border_steps();
        assert_eq!((steps[0], steps[steps.len() - 1]), (0, LAST_STEP));
        assert_eq!(steps.len() as i64, per_tile * parts + 1);
        assert!(steps.is_sorted_by(|one, next| one < next));
        assert!((0..=per_tile).all(|node| steps.binary_search(&nodes.step(node)).is_ok()));
    }
    assert_eq!(
        RasterNodes { tiling: Tiling::Geographic, level: 9, per_tile: 16, parts: 4 }
            .cell_of(LAST_STEP),
        15
    );
}
