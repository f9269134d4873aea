//! Geometries in the form in which GDAL writes them.

use super::*;

#[test]
fn heights_of_next_to_nothing_stay_so_in_texts() {
    for height in [4.5e-10, -1.2e-20, 3.4e-30] {
        let lines = FeatureGeometry::Lines(vec![vec![[7.0, 46.0, height], [7.5, 46.5, 1.5]]]);
        let wkt = geometry(&lines, ShapeKind::Lines).unwrap().wkt().unwrap();
        let text = wkt.split("7 46 ").nth(1).or_else(|| wkt.split("7.0 46.0 ").nth(1)).unwrap();
        let written: f64 = text.split(',').next().unwrap().parse().unwrap();
        assert!(written.abs() < 1e-9, "{wkt}");
    }
}

#[test]
fn values_keep_all_but_nul() {
    let value = FieldValue::from("A\0\nB");
    assert!(matches!(value, FieldValue::Text(text) if text == "A\u{fffd}\nB"));
}
