//! Interpolation reproduces planes exactly.

use super::*;
use proptest::prelude::*;

fn plane(c: i64, r: i64) -> f64 {
    100.0 + 3.0 * c as f64 - 2.0 * r as f64
}

fn grid(height_m: impl Fn(i64, i64) -> f64) -> (SampleRect, Vec<f64>) {
    let rect = SampleRect { min: [0, 0], max: [40, 40] };
    (rect, (0..1600).map(|k| height_m(k % 40, k / 40)).collect())
}

proptest! {
    /// Planes are reproduced exactly, at any width, and also if a few samples are missing.
    #[test]
    fn planes_come_back(c in 12.0..27.0_f64, r in 12.0..27.0_f64, w in 0.5..9.0_f64, h in 0.5..9.0_f64, hole in 0..40_i64) {
        let truth = 100.0 + 3.0 * c - 2.0 * r;
        let kernel = Kernel::new([w, h]);
        let (rect, whole) = grid(plane);
        let at = |heights: &[f64]| kernel.height_m(&SampleRectangle { rect, heights_m: heights }, [c, r], &mut KernelBuffers::default());
        prop_assert!((at(&whole) - truth).abs() < 1e-9);
        let (_, holed) = grid(|x, y| if x == hole { f64::NAN } else { plane(x, y) });
        let found = at(&holed);
        prop_assert!(found.is_nan() || (found - truth).abs() < 1e-6, "{found} for {truth}");
    }
}

#[test]
fn a_sample_without_weight_does_not_matter() {
    let (rect, heights_m) = grid(|x, y| if x == 11 { f64::NAN } else { plane(x, y) });
    let samples = SampleRectangle { rect, heights_m: &heights_m };
    let at =
        |c: f64| Kernel::new([1.0; 2]).height_m(&samples, [c, 7.25], &mut KernelBuffers::default());
    assert!((at(10.0) - 115.5).abs() < 1e-9 && (at(12.0 - 1e-9) - 121.5).abs() < 1e-6);
    assert!(at(10.1).is_nan() && at(11.0).is_nan() && at(39.5).is_nan() && !at(39.0).is_nan());
}

#[test]
fn the_weights_of_an_average_sum_to_one() {
    let mut weights = AxisWeights::default();
    for k in 0..100 {
        weights.compute(50.0 + f64::from(k) / 37.0, 2.0 + f64::from(k) / 10.0);
        assert!((weights.weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        assert!(weights.weights.iter().all(|&weight| weight > 0.0));
    }
}
