//! Gaps in a grid have no heights and are not counted.

use super::*;

#[test]
fn gaps_are_none_and_not_counted() {
    let grid = HeightGrid::new(2, 2, vec![1.0, f32::NAN, f32::INFINITY, -4.0]);
    assert_eq!(grid.height(0, 0), Some(1.0));
    assert_eq!(grid.height(1, 0), None);
    assert_eq!(grid.height(0, 1), None);
    assert_eq!(grid.count_heights(), 2);
    assert_eq!(grid.range_m(), Some([-4.0, 1.0]));
    assert!(!grid.cell_has_ground(0, 0));
}

#[test]
fn window_keeps_positions() {
    let grid = HeightGrid::from_fn(5, 4, |c, r| (10 * r + c) as f32);
    assert_eq!(grid.window(1, 2, 2, 2).raw(), [21.0, 22.0, 31.0, 32.0]);
}
