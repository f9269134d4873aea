//! Bounds in 16 bits are never too low.

use super::*;

#[test]
fn bounds_in_16_bits_are_never_too_low_and_hardly_too_high() {
    // The value of a 16-bit float by IEEE 754: 10 binary digits after the first.
    let value_of = |bits: u16| {
        let digits = 1.0 + f64::from(bits & 0x3FF) / 1024.0;
        digits * 2.0_f64.powi(i32::from(bits >> 10) - 15)
    };
    assert_eq!((f16_above(0.0), f16_above(1.0), f16_above(65_504.0)), (0, 0x3C00, 0x7BFF));
    for k in 0..4000 {
        let value = 1e-4 * 1.005_f32.powi(k);
        let coded = value_of(f16_above(value));
        let exact = f64::from(value.min(65_504.0));
        assert!((exact..=exact * 1.001).contains(&coded), "{value} became {coded}");
    }
    assert!(value_of(f16_above(1e-9)) < 1e-4 && value_of(f16_above(f32::INFINITY)) > 65_503.0);
}
