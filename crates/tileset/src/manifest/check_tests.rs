//! Numbers of a manifest are finite and within their ranges.

use super::{MAX_MEASURE_M, is_height_quantum, measure};

#[test]
fn a_height_quantum_is_a_power_of_two_of_usable_size() {
    for exponent in -64..=27 {
        assert!(is_height_quantum(2_f64.powi(exponent)));
    }
    for not in [0.0, -0.25, 0.3, 3.0, f64::NAN, f64::INFINITY, 2_f64.powi(28), 2_f64.powi(-65)] {
        assert!(!is_height_quantum(not), "{not}");
    }
    // Any height is a valid measure, and its square fits in an f32.
    let highest_m = f64::from(i32::MIN).abs() * 2_f64.powi(27);
    assert!(highest_m <= MAX_MEASURE_M && MAX_MEASURE_M * MAX_MEASURE_M < f64::from(f32::MAX));
}

#[test]
fn a_measure_is_finite_and_not_negative() {
    for length_m in [0.0, -0.0, 1e-300, MAX_MEASURE_M] {
        assert!(measure("it", length_m).is_ok());
    }
    for length_m in [-1e-9, f64::NAN, f64::INFINITY, 1.1 * MAX_MEASURE_M] {
        assert!(measure("it", length_m).unwrap_err().starts_with("it is "));
    }
}
