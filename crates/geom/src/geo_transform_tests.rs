//! The inverse of a geotransform restores positions, if there is an inverse.

use super::*;

#[test]
fn inverse_undoes_a_rotated_transform() {
    let transform = GeoTransform { coefficients: [1000.0, 3.0, 1.0, 2000.0, 0.5, -4.0] };
    let pixel = transform.pixel_from_crs(transform.crs_from_pixel([12.5, 7.25])).unwrap();
    assert!((pixel[0] - 12.5).abs() < 1e-10 && (pixel[1] - 7.25).abs() < 1e-10);
}

#[test]
fn a_flat_transform_has_no_inverse() {
    let flat = GeoTransform { coefficients: [0.0, 1.0, 2.0, 0.0, 2.0, 4.0] };
    assert_eq!(flat.pixel_from_crs([1.0, 1.0]), None);
}
