//! The true lengths of pieces add up to that of the segment, exactly.

use proptest::prelude::*;

use super::*;

proptest! {
    /// Whatever cuts a segment, its pieces add up to it, exactly.
    #[test]
    fn pieces_add_up(ends in any::<[i32; 4]>(), cuts in proptest::collection::vec(0.0..1.0_f64, 0..20), segment_um in 0_u64..1 << 50) {
        let point = |u: i32, v: i32| LatticePoint::new(i64::from(u), i64::from(v));
        let segment = [point(ends[0], ends[1]), point(ends[2], ends[3])];
        prop_assume!(segment[0] != segment[1]);
        let mut shares: Vec<f64> = cuts.iter().map(|t| {
            let along = |a: i64, b: i64| a + ((b - a) as f64 * t).round() as i64;
            share(segment, LatticePoint::new(along(segment[0].u, segment[1].u), along(segment[0].v, segment[1].v)))
        }).collect();
        shares.extend([share(segment, segment[0]), share(segment, segment[1])]);
        shares.sort_by(f64::total_cmp);
        let ends_um: Vec<u64> = shares.iter().map(|&share| cut_um(share, segment_um)).collect();
        prop_assert_eq!(ends_um[0], 0);
        prop_assert_eq!(ends_um.windows(2).map(|pair| pair[1] - pair[0]).sum::<u64>(), segment_um);
    }
}
