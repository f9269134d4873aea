//! The length of a degree matches the tables, and axes that count backwards are known.

use crate::crs::crs_text;

/// WGS84 at 45 degrees: Snyder 1987, table 3: 1 degree of latitude 111 131.7 m, of longitude 78
/// 846.8 m.
#[test]
fn a_degree_is_as_long_as_the_tables_say() {
    let (crs, _) = crs_text::crs_from_text("--dem-crs", "EPSG:4326").unwrap();
    let [east_m, north_m] = crs.metres_per_turn_unit(45.0).unwrap().unwrap();
    assert!(
        (east_m - 78_846.8).abs() < 0.1 && (north_m - 111_131.8).abs() < 0.1,
        "{east_m} {north_m}"
    );
    let (grads, _) = crs_text::crs_from_text("--dem-crs", "EPSG:4807").unwrap();
    let [_, grad_m] = grads.metres_per_turn_unit(45.0).unwrap().unwrap();
    assert!((grad_m - 100_000.0).abs() < 50.0, "a grad of latitude is 100 km: {grad_m}");
    assert_eq!(
        crs_text::crs_from_text("--crs", "EPSG:32632")
            .unwrap()
            .0
            .metres_per_turn_unit(45.0)
            .unwrap(),
        None
    );
}

#[test]
fn axes_that_count_back_are_known_and_polar_ones_left() {
    let check = |code: &str, signs: [f64; 2]| {
        assert_eq!(crs_text::crs_from_text("--crs", code).unwrap().0.signs(), signs, "{code}");
    };
    check("EPSG:32632", [1.0, 1.0]);
    check("EPSG:31467", [1.0, 1.0]);
    check("EPSG:2053", [-1.0, -1.0]);
    check("EPSG:3413", [1.0, 1.0]);
    check("EPSG:3031", [1.0, 1.0]);
}
