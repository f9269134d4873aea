//! A sample far beyond all of its neighbours is a spike; one next to a similar sample, or on a
//! cliff, is not.

use super::*;

const COLUMNS: usize = 5;

/// Five by five samples of 300 m, some of them changed.
fn plain(changed: &[([usize; 2], f64)]) -> Vec<f64> {
    let mut heights_m = vec![300.0; COLUMNS * COLUMNS];
    for &([column, row], height_m) in changed {
        heights_m[row * COLUMNS + column] = height_m;
    }
    heights_m
}

fn found(heights_m: &[f64]) -> Vec<[usize; 2]> {
    let candidates = candidates(heights_m, COLUMNS, LEAST_M).into_iter();
    candidates.filter(|&at| is_spike(heights_m, COLUMNS, at, LEAST_M)).collect()
}

#[test]
fn a_single_sample_more_than_2000_m_beyond_all_neighbours_is_found_wherever_it_lies() {
    for at in [[2, 2], [0, 0], [4, 0], [0, 4], [4, 4], [0, 2], [2, 0]] {
        for height_m in [2300.5, -1700.5, 8000.0, -9999.0] {
            assert_eq!(found(&plain(&[(at, height_m)])), [at], "{height_m}");
        }
        for height_m in [2300.0, -1700.0, 300.0, f64::NAN] {
            assert!(found(&plain(&[(at, height_m)])).is_empty(), "{height_m}");
        }
    }
}

#[test]
fn two_side_by_side_and_cliffs_are_none() {
    assert!(found(&plain(&[([1, 1], 5000.0), ([2, 2], 4000.0)])).is_empty());
    let cliff: Vec<f64> = (0..25).map(|k| if k % COLUMNS < 2 { -4000.0 } else { 300.0 }).collect();
    assert!(found(&cliff).is_empty());
}

/// Voids are not compared; three neighbours are enough.
#[test]
fn neighbours_without_height_do_not_count() {
    let mut alone = vec![f64::NAN; 25];
    alone[12] = 5000.0;
    assert!(found(&alone).is_empty());
    for (at, is_found) in [(6, false), (7, false), (8, true)] {
        alone[at] = 100.0;
        assert_eq!(found(&alone) == [[2, 2]], is_found, "{at}");
    }
}

/// Only on the rim of a block are some neighbours unknown: only these samples are read again.
#[test]
fn among_voids_candidates_are_on_the_rim_alone() {
    for (at, is_candidate) in [([2, 2], false), ([1, 3], false), ([0, 2], true), ([4, 4], true)] {
        let mut alone = vec![f64::NAN; 25];
        alone[at[1] * COLUMNS + at[0]] = 5000.0;
        let expected = if is_candidate { vec![at] } else { vec![] };
        assert_eq!(candidates(&alone, COLUMNS, LEAST_M), expected);
        assert_eq!(is_on_rim([COLUMNS; 2], at), is_candidate);
    }
    // Two neighbours are too few to judge a sample, and the rim here is that of the block.
    assert_eq!(candidates(&[300.0, 5000.0], 2, LEAST_M), [[0, 0], [1, 0]]);
}

#[test]
fn parts_merge_to_the_first_few_in_any_order() {
    let spike =
        |k: usize| Spike { row: k / 7, column: k % 7, height_m: k as f64, stored: k as f64 };
    let mut whole = Spikes::default();
    (0..20).for_each(|k| whole.add(spike(k)));
    let parts = [[3, 19], [0, 5], [11, 2]].map(|[a, b]| {
        let mut part = Spikes::default();
        for k in [a, b] {
            part.add(spike(k));
        }
        part
    });
    let mut rest = Spikes::default();
    (0..20).filter(|k| ![3, 19, 0, 5, 11, 2].contains(k)).rev().for_each(|k| rest.add(spike(k)));
    for part in &parts {
        rest.merge(part);
    }
    assert_eq!(rest, whole);
    assert_eq!((whole.count, whole.first.len(), whole.first[2]), (20, 3, spike(2)));
}
