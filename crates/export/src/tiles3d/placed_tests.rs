//! Positions of a 3D tile fit an f32 exactly.

use super::{TileBox, step_m};

/// The step is the smallest power of two with which an f32 holds every position of a tile, and
/// never finer than a millimetre.
#[test]
fn steps_fit_an_f32() {
    for (reach_m, expected_log2) in [(10.0, -10), (16_384.0, -10), (16_385.0, -9), (100_000.0, -7)]
    {
        let step = step_m(reach_m);
        assert_eq!(step.to_bits(), 2.0_f64.powi(expected_log2).to_bits(), "{reach_m}");
        let furthest = (reach_m / step).round() * step;
        assert_eq!(f64::from(furthest as f32).to_bits(), furthest.to_bits());
        let next = furthest - step;
        assert_eq!(f64::from(next as f32).to_bits(), next.to_bits());
    }
}

#[test]
fn boxes_hold_what_is_put_in() {
    let turned = [[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 1.0]];
    let mut inner = TileBox::along(turned);
    inner.include([1.0, 2.0, 3.0]);
    inner.include([-4.0, 5.0, -6.0]);
    let mut outer = TileBox::along([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    outer.include_box(&inner);
    let numbers = outer.numbers();
    let holds =
        |at: [f64; 3]| (0..3).all(|axis| (at[axis] - numbers[axis]).abs() <= numbers[3 + 4 * axis]);
    assert!(holds([1.0, 2.0, 3.0]) && holds([-4.0, 5.0, -6.0]) && !holds([9.0, 0.0, 0.0]));
    assert!(outer.diagonal_m() >= inner.diagonal_m());
}
