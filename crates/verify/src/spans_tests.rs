//! Crossings in the wrong order are found, except those that the manifest records.

use super::*;

#[test]
fn reversed_crossings_beyond_those_that_are_told_break_the_order() {
    let crossing = |upper: i64, free_m: f64| OrderedCrossing { way_ids: [upper, 9], free_m };
    let all = || vec![crossing(3, -0.5), crossing(1, 0.4), crossing(2, -0.04), crossing(4, -6.0)];
    for (told, broken) in [(0, 2), (1, 1), (2, 0)] {
        let mut findings = Findings::default();
        let kept = reversed(all(), 0.05, &mut findings);
        let kept = kept.into_iter().map(|crossing| (TileId::ROOT, crossing)).collect();
        look_at_reversed(told, kept, &mut findings);
        let check = findings.check_mut(CheckId::SpanOrder);
        assert_eq!((check.checked, check.broken), (4, broken), "{told}");
    }
}
