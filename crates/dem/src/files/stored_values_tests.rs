//! Stored values become heights: sentinels, signs and depths are understood.

use super::*;

fn plain() -> StoredValues {
    StoredValues {
        nodata: Vec::new(),
        is_f32: false,
        is_signed_byte: false,
        scale: 1.0,
        offset: 0.0,
        unit_m: 1.0,
        has_mask: false,
    }
}

fn check(values: &StoredValues, stored: &[f64], expected: &[Option<f64>]) {
    let mut found = stored.to_vec();
    values.convert(&mut found);
    let found: Vec<Option<f64>> =
        found.into_iter().map(|height_m| (!height_m.is_nan()).then_some(height_m)).collect();
    assert_eq!(found, expected);
}

#[test]
fn sentinels_are_compared_in_the_precision_of_the_file() {
    let values = StoredValues {
        nodata: vec![-3.4e38, -9999.9],
        is_f32: true,
        scale: 2.0,
        offset: 10.0,
        unit_m: 0.3048,
        ..plain()
    };
    let stored = [f64::from(-3.4e38_f32), f64::from(-9999.9_f32), 5.0, f64::INFINITY, 4e-27];
    let tiny = Some((4e-27 * 2.0 + 10.0) * 0.3048);
    check(&values, &stored, &[None, None, Some(20.0 * 0.3048), None, tiny]);
}

#[test]
fn what_lies_beyond_the_centre_of_the_earth_is_no_height() {
    let stored = [1e20, -1e20, 1e38, f64::NAN, 9_999_999.0, 10_000_001.0, -11_000.0];
    let heights = [None, None, None, None, Some(9_999_999.0), None, Some(-11_000.0)];
    check(&plain(), &stored, &heights);
}

#[test]
fn bytes_with_a_sign_keep_it_and_depths_are_turned_over() {
    let values = StoredValues { nodata: vec![-128.0], is_signed_byte: true, ..plain() };
    check(&values, &[251.0, 127.0, 128.0], &[Some(-5.0), Some(127.0), None]);
    check(&StoredValues { unit_m: -1.0, ..plain() }, &[30.0, -2.0], &[Some(-30.0), Some(2.0)]);
}
