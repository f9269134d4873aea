//! Smoothing keeps the points of a line and rounds its corners.

use super::*;

fn place(at_m: [f64; 2]) -> DrawnPoint {
    DrawnPoint { lon_lat_deg: [at_m[0] / 1e5, at_m[1] / 1e5], at_m }
}

fn line(places: &[[f64; 2]], is_area: bool) -> DocumentLine {
    let points = places.iter().map(|at| place(*at)).collect();
    DocumentLine { id: 1, feature: None, is_area, points }
}

#[test]
fn points_of_the_line_stay_and_a_straight_line_stays_straight() {
    let bent = line(&[[0.0, 0.0], [100.0, 0.0], [100.0, 80.0], [30.0, 120.0]], false);
    let curve = smoothed(&bent, place).unwrap();
    assert_eq!(curve.len(), 3 * MOST_PIECES + 1);
    for (index, point) in bent.points.iter().enumerate() {
        assert_eq!(curve[index * MOST_PIECES], *point);
    }
    let straight = line(&[[0.0, 0.0], [10.0, 5.0], [100.0, 50.0]], false);
    for point in smoothed(&straight, place).unwrap() {
        let [x, y] = point.at_m;
        assert!((y - x / 2.0).abs() < 1e-9, "{x} {y}");
    }
}

/// A regular polygon with many corners is nearly its circle; the curve around it is much nearer.
#[test]
fn a_polygon_becomes_a_circle() {
    let radius_m = 1000.0;
    let corner = |number: usize| {
        let angle = number as f64 / 12.0 * std::f64::consts::TAU;
        [radius_m * angle.cos(), radius_m * angle.sin()]
    };
    let corners: Vec<[f64; 2]> = (0..12).map(corner).collect();
    let curve = smoothed(&line(&corners, true), place).unwrap();
    assert_eq!(curve.len(), 12 * MOST_PIECES);
    let closing = curve.iter().chain(curve.first());
    let closing: Vec<DVec2> = closing.map(|point| DVec2::from_array(point.at_m)).collect();
    let off = closing.windows(2).map(|pair| radius_m - pair[0].midpoint(pair[1]).length());
    let most_m = off.map(f64::abs).fold(0.0, f64::max);
    // The sides of the polygon are 34 m inside.
    assert!(most_m < 3.0, "{most_m}");
}

#[test]
fn what_has_no_corner_stays() {
    let few = |places: &[[f64; 2]], is_area| {
        assert_eq!(
            smoothed(&line(places, is_area), place),
            Err(Unchanged::FewPoints),
            "{places:?}"
        );
    };
    few(&[[0.0, 0.0], [1.0, 1.0]], false);
    few(&[[0.0, 0.0], [0.0, 0.0], [1.0, 1.0]], false);
    few(&[[0.0, 0.0], [1.0, 1.0], [0.0, 0.0]], true);
    let many: Vec<[f64; 2]> = (0..=MOST_POINTS / MOST_PIECES).map(|x| [x as f64, 0.0]).collect();
    let told = smoothed(&line(&many, false), place).unwrap_err();
    assert!(matches!(told, Unchanged::ManyPoints { .. }));
}
