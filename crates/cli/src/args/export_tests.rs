//! Coordinate systems of exports are parsed or rejected.

use super::*;

#[test]
fn coordinate_systems_are_named_by_their_codes() {
    assert_eq!(parse_crs("package"), Ok(FeatureCoordinates::Package));
    assert_eq!(parse_crs("epsg:4979"), Ok(FeatureCoordinates::Wgs84));
    assert_eq!(parse_crs("EPSG:4326"), Ok(FeatureCoordinates::Wgs84WithPackageHeights));
    for written in ["EPSG:2056", "2056", "epsg: 2056"] {
        assert_eq!(parse_crs(written), Ok(FeatureCoordinates::Epsg(2056)), "{written}");
    }
    assert_eq!(parse_crs("Epsg:32632"), Ok(FeatureCoordinates::Epsg(32632)));
    for unknown in ["EPSG:", "ESRI:54030", "EPSG:-1", "utm", ""] {
        assert!(parse_crs(unknown).unwrap_err().contains("ogr2ogr"), "{unknown}");
    }
}
