//! Coordinate systems of exports are read or refused.

use super::*;

#[test]
fn only_two_coordinate_systems_can_be_asked_for() {
    assert_eq!(parse_crs("package"), Ok(ExportCrs::Package));
    assert_eq!(parse_crs("epsg:4979"), Ok(ExportCrs::Wgs84));
    assert!(parse_crs("EPSG:2056").unwrap_err().contains("ogr2ogr"));
}
