//! The systems whose x repeats after a turn around the earth, and their periods.

use super::*;
use crate::crs::wkt::wkt2;

fn turn(code: u32) -> Option<f64> {
    let reference = SpatialRef::from_epsg(code).unwrap();
    turn_of(&reference, &wkt2(&reference).unwrap())
}

/// A turn is 2π times the radius of the equator, by the scale of the projection: on a cylinder that
/// is true at a latitude φ on WGS84, 2π N cos φ.
#[test]
fn cylinders_have_a_turn() {
    let equator_m = std::f64::consts::TAU * 6_378_137.0;
    let true_at = |lat_deg: f64| std::f64::consts::TAU * corniche_geom::wgs84::radii_m(lat_deg)[0];
    for (code, expected_m) in [
        (3857, equator_m),
        (3395, equator_m),
        (3832, equator_m),
        (4087, equator_m),
        (32662, equator_m),
        // NSIDC EASE-Grid 2.0 Global: equal areas, true at 30 degrees.
        (6933, true_at(30.0)),
        // World Mercator with a true latitude of −41 degrees, in New Zealand.
        (3994, true_at(-41.0)),
    ] {
        let found = turn(code).unwrap();
        assert!((found - expected_m).abs() < 1e-6, "{code}: {found}, not {expected_m}");
    }
}

/// Transverse and oblique cylinders, cones and planes do not repeat.
#[test]
fn others_have_none() {
    for code in [32632, 32760, 2193, 3034, 3413, 2056, 3035, 3338] {
        assert_eq!(turn(code), None, "{code}");
    }
}
