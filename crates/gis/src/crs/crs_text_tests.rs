//! A compound CRS is split into its horizontal and its vertical part.

use super::*;

#[test]
fn a_compound_system_is_split_into_plan_and_height() {
    let (crs, vertical) = crs_from_text("--dem-crs", "EPSG:32633+6360").unwrap();
    let vertical = vertical.unwrap();
    assert_eq!((crs.label.as_str(), vertical.is_down), ("EPSG:32633", false));
    assert_eq!(vertical.name, "NAVD88 height (ftUS)");
    assert_eq!(vertical.unit_m.to_bits(), (1200.0_f64 / 3937.0).to_bits());
}
