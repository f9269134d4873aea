//! The scales of UTM and Web Mercator are those of their formulas.

use super::*;
use crate::crs::crs_text;
use crate::crs::horizontal::Crs;

fn scale_at(crs: &str, point_m: [f64; 2]) -> LocalScale {
    let crs = crs_text::crs_from_text("--crs", crs).unwrap().0;
    let operation = CrsOperation::new(&crs, &Crs::wgs84().unwrap(), None);
    scales(&operation, &[point_m]).unwrap()[0].unwrap()
}

#[test]
fn utm_is_0_9996_on_its_meridian() {
    let scale = scale_at("EPSG:32632", [500_000.0, 5_200_000.0]);
    assert!(scale.along.iter().all(|along| (along - 0.9996).abs() < 1e-7));
    assert!((scale.deviation - 0.0004).abs() < 1e-7);
}

#[test]
fn web_mercator_stretches_by_the_secant() {
    let scale = scale_at("EPSG:3857", [1_000_000.0, 6_000_000.0]);
    let latitude = (6_000_000.0_f64 / SEMI_MAJOR_M).sinh().atan();
    assert!(
        scale.along.iter().all(|along| (along * latitude.cos() - 1.0).abs() < 0.005),
        "{scale:?}"
    );
}

#[test]
fn the_middle_lies_across_the_antimeridian_and_at_the_pole() {
    let middle = center_deg(&[[179.0, 10.0], [-178.0, 10.0]]).unwrap();
    assert!((middle[0] + 179.5).abs() < 1e-9, "{middle:?}");
    let pole = center_deg(&[[0.0, 80.0], [90.0, 80.0], [180.0, 80.0], [-90.0, 80.0]]).unwrap();
    assert!((pole[1] - 90.0).abs() < 1e-6);
    assert!(center_deg(&[]).is_none());
}
