//! The positions of lines along their ways are found.

use super::*;

const NEAR: f64 = 2000.0;

fn way(places: &[[f64; 2]]) -> Vec<SmoothLine> {
    let mut along_m = 0.0;
    let mut before: Option<[f64; 2]> = None;
    let station = |&at: &[f64; 2]| {
        if let Some(before) = before.replace(at) {
            along_m += (at[0] - before[0]).hypot(at[1] - before[1]) / 1000.0;
        }
        Station { at, along_m, height_m: 0.0, ground_m: 0.0 }
    };
    vec![SmoothLine { stations: places.iter().map(station).collect() }]
}

fn line(places: &[[f64; 2]]) -> Vec<Vertex> {
    places.iter().map(|&at| Vertex { at, z_m: 0.0, is_source: true }).collect()
}

#[test]
fn a_part_lies_where_it_is_nearest() {
    let way = way(&[[0.0, 0.0], [50_000.0, 0.0], [50_000.0, 30_000.0]]);
    let found = stretch_of_way(&way, &line(&[[20_000.0, 400.0], [50_000.0, 10_000.0]]), 40.0, NEAR);
    assert_eq!(found, Some([20.0, 60.0]));
    assert_eq!(stretch_of_way(&[], &line(&[[0.0, 0.0], [1.0, 0.0]]), 1.0, NEAR), None);
}

/// The beginning of a ring is also its end.
#[test]
fn a_ring_is_as_long_as_it_is() {
    let ring = [[0.0, 0.0], [10_000.0, 0.0], [10_000.0, 10_000.0], [0.0, 10_000.0], [0.0, 0.0]];
    assert_eq!(stretch_of_way(&way(&ring), &line(&ring), 40.0, NEAR), Some([0.0, 40.0]));
    let half = [[10_000.0, 10_000.0], [0.0, 10_000.0], [0.0, 0.0]];
    assert_eq!(stretch_of_way(&way(&ring), &line(&half), 20.0, NEAR), Some([20.0, 40.0]));
}

/// A line that is far away, or longer than the way there, is not found; a simplified line is a
/// little shorter.
#[test]
fn what_is_no_part_of_the_way_is_not_found() {
    let way = way(&[[0.0, 0.0], [500_000.0, 0.0]]);
    let found =
        |places: &[[f64; 2]], length_m: f64| stretch_of_way(&way, &line(places), length_m, NEAR);
    assert_eq!(found(&[[0.0, 2500.0], [400_000.0, 0.0]], 400.0), None);
    assert_eq!(found(&[[0.0, 0.0], [100_000.0, 0.0]], 400.0), None);
    assert_eq!(found(&[[0.0, 0.0], [400_000.0, 0.0]], 390.0), Some([0.0, 400.0]));
}

/// A way that goes back and forth between two places: each end matches many distances.
#[test]
fn a_way_to_and_fro_is_searched_in_order() {
    let ends = [[0.0, 0.0], [100_000.0, 0.0]];
    let places: Vec<[f64; 2]> = (0..20_001).map(|k| ends[k % 2]).collect();
    let way = way(&places);
    let found = stretch_of_way(&way, &line(&[ends[0], ends[1]]), 2_000_100.0 - 100.0, NEAR);
    assert!(found.is_some_and(|[from_m, to_m]| (to_m - from_m - 2e6).abs() <= 100.0), "{found:?}");
}
