//! Between the corners of a tile the scale is that of the coordinate table.

use corniche_testing::FlatProjection;

use super::*;

/// The working metres of a DEM in geographic coordinates.
fn geographic() -> FlatProjection {
    FlatProjection::new([8e4, 1e5])
}

#[test]
fn between_the_corners_of_a_tile_the_scale_is_that_of_the_table() {
    let bounds = Bounds { min_x: 7.2e5, min_y: 4.65e6, max_x: 8.0e5, max_y: 4.75e6 };
    let table = CoordinateTable::sample(&geographic(), bounds, 0.01).unwrap();
    // The tile extends beyond the data in the north-east.
    let tile = Bounds { min_x: 7.7e5, min_y: 4.73e6, max_x: 8.3e5, max_y: 4.79e6 };
    let scale = PlanScale::of_tile(&table, tile, 1.0);
    for at in [[7.7e5, 4.73e6], [7.9e5, 4.742e6], [8.0e5, 4.75e6]] {
        let ([east, north], truth) = (scale.at(at), table.scale_at(at).unwrap());
        assert!((east / truth[0] - 1.0).abs() < 1e-5, "{east} {truth:?}");
        assert!((north / truth[1] - 1.0).abs() < 1e-5, "{north} {truth:?}");
    }
    let [east, north] = scale.at([7.8e5, 4.74e6]);
    let across = |by: [f64; 2]| scale.across([[7.8e5, 4.74e6], [7.8e5 + by[0], 4.74e6 + by[1]]]);
    // The width of a road that runs east is measured northwards; the width of a road that runs
    // north is measured eastwards.
    assert!((across([10.0, 0.0]) / north - 1.0).abs() < 1e-5);
    assert!((across([0.0, -10.0]) / east - 1.0).abs() < 1e-5);
}
