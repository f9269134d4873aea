//! A recorded CRS is the same by its code and by its WKT.

use corniche_geom::Projection as _;

use super::*;

#[test]
fn a_code_and_its_wkt_are_one_system() {
    let data =
        Bounds { min_x: 500_000.0, min_y: 5_200_000.0, max_x: 510_000.0, max_y: 5_210_000.0 };
    let by_code = RecordedCrs::new("EPSG:32632", [1.0; 2], data).unwrap();
    let by_wkt = RecordedCrs::new(&by_code.working.crs.wkt, [1.0; 2], data).unwrap();
    assert_eq!(by_wkt.label(), "EPSG:32632");
    let area = Bounds { min_x: 9.0, min_y: 47.0, max_x: 10.0, max_y: 48.0 };
    let mut points = [[[9.5, 47.1]], [[9.5, 47.1]]];
    for (crs, point) in [by_code, by_wkt].iter().zip(&mut points) {
        crs.projection(area).unwrap().working_from_wgs84(point).unwrap();
    }
    assert_eq!(points[0][0].map(f64::to_bits), points[1][0].map(f64::to_bits));
}

#[test]
fn text_that_is_no_crs_is_refused() {
    assert!(RecordedCrs::new("PROJCRS[", [1.0; 2], Bounds::EMPTY).is_err());
}

/// PROJ subtracts turns from a longitude one by one, and never ends if this does not change the
/// number. An impossible position has no image.
#[test]
fn positions_beyond_all_places_have_no_image_and_take_no_time() {
    let data = Bounds { min_x: 0.0, min_y: 0.0, max_x: 1e12, max_y: 1e12 };
    let area = Bounds { min_x: 9.0, min_y: 47.0, max_x: 10.0, max_y: 48.0 };
    for (text, factor) in [
        ("EPSG:32632", 1.0),
        ("EPSG:2056", 1.0),
        ("EPSG:4230", 1e-6),
        ("EPSG:3857", 1.0),
        ("EPSG:31467", 1.0),
    ] {
        let crs = RecordedCrs::new(text, [factor; 2], data).unwrap();
        let projection = crs.projection(area).unwrap();
        for far in [1e17, 1e300, f64::INFINITY, f64::NAN] {
            for mut points in [[[far, 47.0]], [[9.5, far]]] {
                projection.working_from_wgs84(&mut points).unwrap();
                assert!(points[0][0].is_nan(), "{text}: {points:?}");
            }
            for mut points in [[[far, 5e6]], [[5e5, -far]]] {
                projection.wgs84_from_working(&mut points).unwrap();
                assert!(points[0][0].is_nan(), "{text}: {points:?}");
            }
        }
        let mut turned = [[9.5 + 360.0, 47.1]];
        projection.working_from_wgs84(&mut turned).unwrap();
        assert!(turned[0][0].is_finite(), "{text}: a turn more is a place");
        crs.datum_operations(data, area).unwrap();
    }
}
