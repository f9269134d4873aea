//! The recorded name of a vertical CRS leads back to the system, without guesses.

use super::*;

const BOUNDS: Bounds = Bounds { min_x: 9.0, min_y: 47.0, max_x: 10.0, max_y: 48.0 };

fn find(crs: &str, datum: &str, named: &[&str]) -> Option<RecordedHeights> {
    let data = Bounds { min_x: 0.0, min_y: 0.0, max_x: 1e5, max_y: 1e5 };
    let crs = RecordedCrs::new(crs, [1.0; 2], data).unwrap();
    RecordedHeights::find(&crs, datum, named, BOUNDS).unwrap()
}

/// The recorded name leads back to the system, whether it was given or is registered; nothing is
/// guessed.
#[test]
fn a_vertical_system_is_found_by_its_recorded_name() {
    let code = |datum: &str, named: &[&str]| {
        let found = find("EPSG:32632", datum, named)?;
        Some(found.vertical.wkt.rsplit("ID[").next()?.trim_end_matches(']').to_owned())
    };
    assert_eq!(code("EGM96 height", &[]).as_deref(), Some("\"EPSG\",5773"));
    assert_eq!(code("EGM2008 height", &[]).as_deref(), Some("\"EPSG\",3855"));
    assert_eq!(code("ellipsoidal height (WGS 84)", &[]).as_deref(), Some("\"EPSG\",4979"));
    assert_eq!(code("NAVD88 height", &["EPSG:5703"]).as_deref(), Some("\"EPSG\",5703"));
    assert_eq!(code("unknown", &[]), None);
    assert_eq!(code("unknown", &["EPSG:5773"]), None, "what was given is not what is recorded");
    assert_eq!(code("EGM96 height, shifted by +10 m", &["EPSG:5773"]), None);
}

/// PROJ can read the compound CRS; its heights are in metres although the found system is in feet.
#[test]
fn a_compound_crs_has_metres_upwards() {
    for (datum, named) in
        [("EGM96 height", "EPSG:5773"), ("North American Vertical Datum 1988", "EPSG:6360")]
    {
        let wkt = find("EPSG:32632", datum, &[named]).unwrap().wkt().unwrap();
        let read = gdal::spatial_ref::SpatialRef::from_wkt(&wkt).unwrap();
        assert!(read.is_compound() && read.is_projected(), "{wkt}");
        let vertical = VerticalCrs::of_wkt(&wkt).unwrap().unwrap();
        assert!((vertical.unit_m - 1.0).abs() < 1e-15 && !vertical.is_down, "{wkt}");
        assert!(wkt.contains("ID[\"EPSG\",5773]") || wkt.contains("ID[\"EPSG\",5703]"), "{wkt}");
    }
}

/// Ellipsoidal heights give a CRS of three axes if the horizontal system is that of the ellipsoid.
#[test]
fn ellipsoidal_heights_make_three_axes() {
    let datum = "ellipsoidal height (WGS 84)";
    assert!(find("EPSG:4326", datum, &[]).unwrap().wkt().unwrap().contains("ellipsoidal height"));
    assert_eq!(find("EPSG:32632", datum, &[]).unwrap().wkt(), None);
}

/// Heights above the ellipsoid of WGS84 stay unchanged.
#[test]
fn heights_of_wgs84_stay() {
    let heights = find("EPSG:32632", "ellipsoidal height (WGS 84)", &[]).unwrap();
    let mut values = [1234.5];
    heights.to_wgs84_m(&[[5e5, 5.2e6]], &mut values).unwrap();
    assert_eq!(values.map(f64::to_bits), [1234.5_f64.to_bits()]);
}
