//! Numbers and names of roads as people write them.

use super::*;

fn way(reference: &str, name: &str) -> RoadAttributes {
    RoadAttributes {
        reference: reference.to_owned(),
        name: name.to_owned(),
        ..RoadAttributes::default()
    }
}

fn by_ref(text: &str) -> RoadQuery {
    RoadQuery { reference: Some(text.to_owned()), name: None }
}

#[test]
fn spaces_hyphens_and_case_do_not_matter() {
    for (wanted, written) in [
        ("CG 2", "CG-2"),
        ("cg2", "CG 2"),
        ("CG\u{2011}2", "cg 2"),
        ("a1", "E 60;A 1"),
        ("ÖV 1", "öv1"),
        ("A 1; E 60", "E 60;A 1;E 62"),
        ("STRASSE 1", "Straße 1"),
        ("E\u{301}COLE", "école"),
    ] {
        assert!(by_ref(wanted).is_met_by(&way(written, "")), "{wanted} {written}");
    }
    for (wanted, written) in [
        ("CG 2", "CG 21"),
        ("CG 2", "CG"),
        ("", ""),
        ("-", ""),
        ("A 1", "A 1a"),
        ("A 1;E 3", "A 1"),
    ] {
        assert!(!by_ref(wanted).is_met_by(&way(written, "")), "{wanted} {written}");
    }
    let both = RoadQuery { name: Some("general road".to_owned()), ..by_ref("cg2") };
    assert!(both.is_met_by(&way("CG 2", "General-Road")));
    assert!(!both.is_met_by(&way("CG 2", "")));
    assert_eq!(both.text(), "ref \"cg2\" and name \"general road\"");
}

#[test]
fn a_road_is_written_as_its_ways_have_it() {
    assert_eq!(by_ref("a1").written("E 60; A 1", "Autobahn"), Some("A 1"));
    assert_eq!(by_ref("a1").written("E 60", "A 1"), None);
    let by_name = RoadQuery { reference: None, name: Some("auto bahn".to_owned()) };
    assert_eq!(by_name.written("A 1", "Autobahn"), Some("Autobahn"));
}

#[test]
fn similar_values_are_reported() {
    let ways = [way("CG 1", ""), way("CG 2;N 2", ""), way("X", ""), way("CG 23", ""), way("", "")];
    assert_eq!(by_ref("CG 3").near(ways.iter()), ["CG 1", "CG 2", "CG 23", "N 2", "X"][..3]);
    assert!(by_ref("Hauptstrasse").near(ways.iter()).is_empty());
}
