//! Sums of sample errors are the same for any split and order of samples.

use proptest::prelude::*;

use super::*;

#[test]
fn figures_of_an_even_spread() {
    let mut sums = SampleSums::new(0.25);
    (0..1000).for_each(|k| sums.add(Some(f64::from(k) / 100.0)));
    sums.add(None);
    let record = sums.record();
    assert_eq!((record.on_tin, record.off_tin), (1000, 1));
    assert!((record.max_m - 9.99).abs() < 1e-12);
    // The root mean square of 0 to 10, evenly distributed: 10 / √3.
    assert!((record.rms_m - 5.771).abs() < 0.002, "{record:?}");
    // 990 samples are below 9.9, which is in the bin from 9.75 to 10.
    assert!((record.p99_m - 9.99).abs() < 1e-12, "{record:?}");
    assert_eq!(SampleSums::new(1.0).record().on_tin, 0);
}

#[test]
fn bins_hold_what_they_are_for_and_are_a_4096th_wide_at_most() {
    let mut last = 0;
    for quanta in (0..20_000).chain((15..63).flat_map(|k| [(1 << k) - 1, 1 << k, 3 << (k - 1)])) {
        let bin = bin_of(quanta);
        assert!(end_of(bin) > quanta as f64 || quanta > 1 << 52, "{quanta}");
        assert!(end_of(bin) <= (quanta + 1) as f64 * (1.0 + 1.0 / 4096.0), "{quanta}");
        last = last.max(bin);
    }
    assert!(last < 52 * 4096 + 4096 && bin_of(u64::MAX) < 54 * 4096, "{last}");
}

#[test]
fn absurd_distances_are_counted_and_do_not_overflow() {
    let mut sums = SampleSums::new(1e-9);
    (0..200).for_each(|_| sums.add(Some(1e18)));
    let record = sums.record();
    assert!((record.max_m - 1e18).abs() < 1.0 && (record.p99_m - 1e18).abs() < 1.0);
}

proptest! {
    /// Any split and order gives the same record, to the last bit.
    #[test]
    fn order_does_not_matter(
        distances_m in proptest::collection::vec(proptest::option::of(0.0..1e4_f64), 0..60), cut in 0_usize..60,
    ) {
        let sum = |distances_m: &[Option<f64>]| {
            let mut sums = SampleSums::new(0.125);
            for &distance_m in distances_m {
                sums.add(distance_m);
            }
            sums
        };
        let (first, last) = distances_m.split_at(cut.min(distances_m.len()));
        let mut turned = sum(last);
        turned.merge(&sum(first));
        prop_assert_eq!(turned, sum(&distances_m));
    }
}
