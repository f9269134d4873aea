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
