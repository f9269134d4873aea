use proptest::prelude::*;

use super::*;

fn candidate(node: u32) -> Candidate {
    Candidate { place: node % 7, node, face: 3, apex: 5, hint: 9 }
}

proptest! {
    /// Bands come from the highest down; within one, places ascend; no fresh candidate is lost, and none outdated comes.
    #[test]
    fn bands_descend_and_places_ascend(errors_m in prop::collection::vec(2.0_f64..1e6, 0..300)) {
        let mut bands = Bands::new(2.0);
        for (node, &error_m) in (0..).zip(&errors_m) {
            prop_assert_eq!(bands.push(error_m, candidate(node)), None);
        }
        let fresh = |candidate: &Candidate| !candidate.node.is_multiple_of(5);
        let mut seen = Vec::new();
        let mut lowest_m = f64::INFINITY;
        while let Some(band) = bands.next(fresh) {
            prop_assert!(band.is_sorted_by(|a, b| (a.place, a.node) < (b.place, b.node)));
            let all_m = band.iter().map(|candidate| errors_m[candidate.node as usize]);
            let [low_m, high_m] =
                all_m.fold([f64::INFINITY, 0.0], |[low, high], m| [low.min(m), high.max(m)]);
            prop_assert!(high_m <= lowest_m && high_m <= 1.125 * low_m, "{low_m} {high_m} after {lowest_m}");
            lowest_m = low_m;
            seen.extend(band.iter().map(|candidate| candidate.node));
        }
        seen.sort_unstable();
        let wanted: Vec<u32> = (0..errors_m.len() as u32).filter(|node| node % 5 > 0).collect();
        prop_assert_eq!(seen, wanted);
    }
}

#[test]
fn what_belongs_to_the_band_at_work_is_given_back() {
    let mut bands = Bands::new(1.0);
    assert_eq!(bands.push(4.0, candidate(1)), None);
    assert_eq!(bands.next(|_| true), Some(vec![candidate(1)]));
    assert_eq!(bands.push(4.9, candidate(2)), Some(candidate(2)));
    assert_eq!(bands.push(900.0, candidate(3)), Some(candidate(3)));
    assert_eq!(bands.push(3.9, candidate(4)), None);
    assert_eq!(bands.next(|_| true), Some(vec![candidate(4)]));
    assert_eq!(bands.next(|_| true), None);
}
