//! Grey values are interpolated between the centres of texels.

use super::*;

#[test]
fn values_are_mixed_between_centres() {
    let grey = Grey { first: [10, -5], columns: 3, values: (0..9).map(|n| n as f32).collect() };
    for (at, expected) in [([10.5, -4.5], 0.0_f32), ([11.0, -4.5], 0.5), ([11.0, -4.0], 2.0)] {
        assert!((grey.at(at) - expected).abs() < 1e-6, "{at:?}");
    }
    assert!(grey.at([10.4, -4.5]).is_nan());
    assert!(grey.at([12.5, -4.5]).is_nan(), "the last centre has no neighbour");
}
