//! Numbers and positions have their usual notation.

use super::*;

#[test]
fn coordinates_are_those_of_the_crs() {
    let utm = WorkingCrs { crs: "EPSG:32632", metres_per_unit: [1.0, 1.0] };
    assert_eq!(coordinates(utm, [539_512.25, 5_221_456.75]), "EPSG:32632  539512.2  5221456.8");
    let degrees = WorkingCrs { crs: "EPSG:4326", metres_per_unit: [75_000.0, 111_000.0] };
    assert_eq!(coordinates(degrees, [750_000.0, 5_272_500.0]), "EPSG:4326  10.000000  47.500000");
    let turned = WorkingCrs { crs: "EPSG:2053", metres_per_unit: [-1.0, -1.0] };
    assert_eq!(coordinates(turned, [-99_995.0, -2.0]), "EPSG:2053  99995.0  2.0");
}

#[test]
fn numbers_read_as_people_write_them() {
    assert_eq!([length(3.25), length(350.2), length(12_345.0)], ["3.2 m", "350 m", "12.3 km"]);
    assert_eq!(mebibytes(3 << 20), "3 MiB");
}

#[test]
fn positions_have_sides_of_the_world() {
    assert_eq!(position([9.5, 47.25]), "47.25000° N, 9.50000° E");
    assert_eq!(position([-70.25, -33.5]), "33.50000° S, 70.25000° W");
    assert_eq!(position([181.0, 0.0]), "0.00000° N, 179.00000° W");
}

#[test]
fn a_heading_is_never_360() {
    assert_eq!([heading(-0.2), heading(359.8), heading(-90.0)], ["000°", "000°", "270°"]);
}
