//! Tie points give the affine map on which they agree.

use super::*;

#[test]
fn tie_points_give_the_map_they_agree_upon_and_no_other() {
    let map = GeoTransform { coefficients: [1000.0, 3.0, 1.0, 2000.0, 0.5, -4.0] };
    let tie = |c: f64, r: f64| {
        let [x, y] = map.crs_from_pixel([c, r]);
        [c, r, x, y]
    };
    let mut ties = vec![tie(0.0, 0.0), tie(50.0, 0.0), tie(50.0, 40.0), tie(0.0, 40.0)];
    let found = affine_through(&ties).unwrap();
    for (a, b) in found.coefficients.iter().zip(map.coefficients) {
        assert!((a - b).abs() < 1e-9);
    }
    ties[2][2] += 1.0;
    assert!(affine_through(&ties).is_none(), "a bent grid is no affine map");
    assert!(affine_through(&[tie(0.0, 0.0), tie(1.0, 1.0), tie(2.0, 2.0)]).is_none());
}
