//! Lines are found where they lie along their way.

use super::*;

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
    let found = stretch_of_way(&way, &line(&[[20_000.0, 400.0], [50_000.0, 10_000.0]]), 40.0);
    assert_eq!(found, Some([20.0, 60.0]));
    assert_eq!(stretch_of_way(&[], &line(&[[0.0, 0.0], [1.0, 0.0]]), 1.0), None);
}

/// The beginning of a ring is also its end.
#[test]
fn a_ring_is_as_long_as_it_is() {
    let ring = [[0.0, 0.0], [10_000.0, 0.0], [10_000.0, 10_000.0], [0.0, 10_000.0], [0.0, 0.0]];
    assert_eq!(stretch_of_way(&way(&ring), &line(&ring), 40.0), Some([0.0, 40.0]));
    let half = [[10_000.0, 10_000.0], [0.0, 10_000.0], [0.0, 0.0]];
    assert_eq!(stretch_of_way(&way(&ring), &line(&half), 20.0), Some([20.0, 40.0]));
}
