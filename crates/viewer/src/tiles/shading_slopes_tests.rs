//! The texels of slopes equal the slopes of the ground.

use corniche_geom::HeightGrid;

use super::*;

const CELL: Cell = Cell { east_m: 10.0, north_m: 20.0 };

/// Ground that rises to the east more and more and falls to the north, with a hole.
fn relief() -> Relief {
    let heights = HeightGrid::from_fn(259, 259, |column, row| {
        if (100..110).contains(&column) && (100..110).contains(&row) {
            return f32::NAN;
        }
        let (east, north) = (column as f32 * 10.0, row as f32 * -20.0);
        500.0 + east * east * 1e-4 - 0.25 * north
    });
    Relief::of_heights(&heights, &heights, CELL, 0.125).unwrap()
}

#[test]
fn texels_are_the_slopes_of_the_ground() {
    let slopes = ShadingSlopes::new(&relief(), CELL);
    for row in 0..257 {
        for column in 0..257 {
            let [east, north] =
                slopes.texels[row * 257 + column].map(|bits| f16::from_bits(bits).to_f64());
            // Near the hole, heights are less exact: its filling is not smooth.
            if (92..116).contains(&column) && (92..116).contains(&row) {
                continue;
            }
            let exact = 2e-4 * (column as f64 + 1.0) * 10.0;
            assert!((east - exact).abs() < 0.01, "{column} {row}: {east}, exact {exact}");
            assert!((north + 0.25).abs() < 0.01, "{column} {row}: {north}");
        }
    }
    let hole = slopes.texels[104 * 257 + 104];
    assert_eq!(hole.map(|bits| f16::from_bits(bits).to_f64()), [0.0, 0.0]);
}
