//! Undeclared values that mean missing data are found.

use super::*;

fn audit(files: &[&[f64]]) -> Audit {
    let mut audit = Audit::new(files.len(), SURFACE_RANGE_M);
    for (file, heights_m) in audit.files.iter_mut().zip(files) {
        heights_m.iter().for_each(|&height_m| file.add(height_m, height_m, SURFACE_RANGE_M));
    }
    audit
}

fn sentinel(heights_m: &[f64]) -> Option<(f64, u64)> {
    let audit = audit(&[heights_m]);
    audit.files[0].sentinel().map(|(entry, _)| (entry.height_m, entry.count))
}

fn hills() -> impl Iterator<Item = f64> {
    (0..50_000).map(|k| f64::from(k % 700) + 100.0)
}

fn with(value: f64, times: usize) -> Vec<f64> {
    hills().chain(std::iter::repeat_n(value, times)).collect()
}

#[test]
fn a_value_far_beyond_all_others_is_found_when_it_is_repeated_often_enough() {
    for value in [-9998.0, -901.0, -900.0, 32_766.0, 65_534.0, 1799.0] {
        // 6 of 50 006 are more than 0.01 %, 5 of 50 005 are not.
        assert_eq!(sentinel(&with(value, 6)), Some((value, 6)), "{value}");
        assert_eq!(sentinel(&with(value, 5)), None, "{value}");
    }
    for value in [-899.0, 0.0, 100.0, 1798.0] {
        assert_eq!(sentinel(&with(value, 20_000)), None, "{value}: no farther than 1000 m");
    }
}

/// Values that programs write for "no data" are rejected from the first sample on, if they lie far
/// from all heights; other values are not.
#[test]
fn a_usual_value_for_no_data_is_found_in_a_single_sample() {
    for value in USUAL_NO_DATA {
        assert_eq!(sentinel(&with(value, 1)), Some((value, 1)), "{value}");
    }
    assert_eq!(sentinel(&with(-9998.0, 1)), None);
    let deep: Vec<f64> = with(-9999.0, 1).into_iter().chain([-9001.0]).collect();
    assert_eq!(sentinel(&deep), None, "998 m from a true depth");
}

#[test]
fn several_values_are_named_from_outside_and_strays_beyond_hide_none() {
    let mut heights_m = with(-9999.0, 100);
    heights_m.extend([-32_767.0; 50]);
    assert_eq!(sentinel(&heights_m), Some((-32_767.0, 50)));
    let mut strays = with(-9999.0, 100);
    strays.extend([-10_000.5, -10_007.0]);
    assert_eq!(sentinel(&strays), Some((-9999.0, 100)));
}

#[test]
fn flat_ground_is_none_of_it_and_of_two_values_the_one_farther_from_the_sea_is() {
    assert_eq!(sentinel(&[5.0; 100]), None);
    assert_eq!(sentinel(&[]), None);
    for value in [-9999.0, 65_535.0] {
        let two: Vec<f64> = [100.0; 400].into_iter().chain([value; 300]).collect();
        assert_eq!(sentinel(&two), Some((value, 300)));
    }
}

/// Blocks, threads and order do not matter, and memory is bounded.
#[test]
fn parts_merge_to_the_same_in_any_order() {
    let heights_m: Vec<f64> =
        (0..9973_u64).map(|k| ((k * 7919) % 997) as f64 * 3.5 - 1000.0).collect();
    let whole = audit(&[&heights_m]);
    for parts in [1, 2, 7, 100] {
        let mut merged = Audit::new(1, SURFACE_RANGE_M);
        for part in heights_m.chunks(heights_m.len().div_ceil(parts)).rev() {
            let found = audit(&[part]).files.remove(0);
            merged.merge(&AuditPart { file: 0, found });
        }
        assert_eq!(merged, whole, "{parts} parts");
    }
    let file = &whole.files[0];
    assert!(file.lowest.entries.len() == KEPT && file.highest.entries.len() == KEPT);
    let counted = heights_m.iter().filter(|&&height_m| height_m + 1000.0 == 0.0).count() as u64;
    assert_eq!((file.lowest.entries[0].height_m, file.lowest.entries[0].count), (-1000.0, counted));
    assert_eq!(file.samples, 9973);
}
