//! A void in a plane is filled with the plane.

use super::*;

#[test]
fn a_void_in_a_plane_gets_the_plane() {
    let mut heights: Vec<f32> = (0..121).map(|k| (k % 11) as f32 * 2.0 + (k / 11) as f32).collect();
    heights[60] = f32::NAN;
    let filled = fill(&heights, 11, 3, Cell { east_m: 20.0, north_m: 30.0 });
    assert_eq!(filled.len(), 1);
    assert_eq!(filled[0].0, 60);
    assert!((filled[0].1 - 15.0).abs() < 1e-5);
}

#[test]
fn one_direction_without_data_is_enough_to_stay_void() {
    let mut heights = vec![1.0_f32; 49];
    heights[24] = f32::NAN;
    // South of the void, all the way within reach.
    (1..=3).for_each(|k| heights[24 + 7 * k] = f32::NAN);
    assert!(fill(&heights, 7, 3, Cell::from(1.0)).is_empty());
    assert_eq!(fill(&[1.0, f32::NAN], 2, 0, Cell::from(1.0)), []);
}
