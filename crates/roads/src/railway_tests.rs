//! Which tags make a railway, and how steep it may be.

use super::*;

fn check(tags: &[(&str, &str)], expected: Option<Railway>) {
    assert_eq!(Railway::from_tags(tags), expected, "{tags:?}");
}

#[test]
fn a_railway_in_use_is_one() {
    check(&[("railway", "rail")], Some(Railway::Rail));
    check(&[("railway", " rail ")], Some(Railway::Rail));
    check(&[("railway", "preserved"), ("rack", "no")], Some(Railway::Rail));
    check(&[("railway", "narrow_gauge")], Some(Railway::NarrowGauge));
    check(&[("railway", "subway")], Some(Railway::Light));
    check(&[("railway", "tram"), ("highway", "residential")], Some(Railway::Tram));
}

#[test]
fn a_rack_allows_any_grade() {
    check(&[("railway", "narrow_gauge"), ("rack", "riggenbach")], Some(Railway::Steep));
    check(&[("railway", "funicular")], Some(Railway::Steep));
}

#[test]
fn what_no_train_uses_is_none() {
    for value in ["construction", "disused", "abandoned", "razed", "platform", "turntable", ""] {
        check(&[("railway", value)], None);
    }
    check(&[("highway", "primary")], None);
    check(&[("railway", "rail"), ("area", "yes")], None);
}

#[test]
fn main_lines_are_built_with_at_most_four_percent() {
    let limits = Railway::ALL.map(Railway::steepest_pct);
    assert!((Railway::Rail.steepest_pct() - 4.0).abs() < 1e-9);
    assert!(limits.iter().all(|limit_pct| (4.0..=100.0).contains(limit_pct)), "{limits:?}");
}
