//! FRC tables classify by their list and by the rule for links, and reject invalid entries.

use super::*;

fn strings(values: &[&str]) -> Vec<String> {
    values.iter().map(ToString::to_string).collect()
}

fn table(
    classes: &[(&str, u8)],
    not_roads: &[&str],
    least_class: u8,
) -> Result<FrcTable, FrcTableError> {
    let classes = classes.iter().map(|&(value, class)| (value.to_owned(), class)).collect();
    FrcTable::new("test", classes, strings(not_roads), least_class)
}

fn small() -> FrcTable {
    table(&[("motorway", 0), ("trunk", 1), ("trunk_link", 5), ("footway", 8)], &["construction"], 7)
        .unwrap()
}

#[track_caller]
fn check(tags: &[(&str, &str)], expected: Classified<'_>) {
    assert_eq!(small().classify(tags), expected, "{tags:?}");
}

#[test]
fn classifies_by_the_list_and_the_link_rule_alone() {
    let class = |n| FunctionalRoadClass::new(n).unwrap();
    check(&[("highway", "motorway")], Classified::Road(class(0)));
    check(&[("highway", "motorway_link")], Classified::Road(class(0)));
    check(&[("highway", "trunk_link")], Classified::Road(class(5)));
    check(&[("highway", "footway")], Classified::NotShown(class(8)));
    check(&[("highway", "footway_link")], Classified::NotShown(class(8)));
    check(&[("highway", "construction")], Classified::NotARoad(NotARoad::Listed));
    check(&[("highway", "construction_link")], Classified::Unknown("construction_link"));
    check(&[("highway", "primary")], Classified::Unknown("primary"));
    check(&[("highway", "Motorway")], Classified::Unknown("Motorway"));
    check(&[("highway", "")], Classified::Unknown(""));
    check(&[("highway", "_link")], Classified::Unknown("_link"));
    check(&[("highway", "motorway_link_link")], Classified::Unknown("motorway_link_link"));
    check(&[("railway", "rail")], Classified::NotARoad(NotARoad::NoHighway));
    check(&[], Classified::NotARoad(NotARoad::NoHighway));
}

#[test]
fn areas_are_not_roads_but_area_no_is() {
    let motorway = FunctionalRoadClass::new(0).unwrap();
    check(&[("highway", "motorway"), ("area", "yes")], Classified::NotARoad(NotARoad::Area));
    check(&[("area", "yes"), ("highway", "footway")], Classified::NotARoad(NotARoad::Area));
    check(&[("highway", "motorway"), ("area", "no")], Classified::Road(motorway));
    // The value is reported first.
    check(&[("highway", "what"), ("area", "yes")], Classified::Unknown("what"));
}

#[test]
fn refuses_entries_that_make_no_table() {
    let twice = table(&[("motorway", 0)], &["motorway"], 7);
    assert_eq!(twice, Err(FrcTableError::Twice { name: "test".into(), value: "motorway".into() }));
    assert!(matches!(
        table(&[("motorway", 9)], &[], 7),
        Err(FrcTableError::Class { class: 9, .. })
    ));
    assert!(matches!(
        table(&[("motorway", 0)], &[], 9),
        Err(FrcTableError::LeastClass { class: 9, .. })
    ));
    assert!(matches!(table(&[("motor way", 0)], &[], 7), Err(FrcTableError::Value { .. })));
    assert!(matches!(table(&[("", 0)], &[], 7), Err(FrcTableError::Value { .. })));
    assert!(matches!(table(&[], &["path"], 7), Err(FrcTableError::NoClasses { .. })));
    let unnamed = FrcTable::new("a b", vec![("motorway".into(), 0)], vec![], 7);
    assert!(matches!(unnamed, Err(FrcTableError::Name { .. })));
}

#[test]
fn any_classes_can_be_on() {
    let class = |n| FunctionalRoadClass::new(n).unwrap();
    let some = small().with_classes(&[5, 0, 8, 5]).unwrap();
    assert_eq!(some.chosen_classes(), Some(vec![0, 5, 8]));
    assert_eq!((some.least_class(), some.own_least_class()), (class(8), class(7)));
    assert_eq!(some.classify(&[("highway", "motorway")]), Classified::Road(class(0)));
    assert_eq!(some.classify(&[("highway", "trunk")]), Classified::NotShown(class(1)));
    assert_eq!(some.classify(&[("highway", "footway")]), Classified::Road(class(8)));
    assert!(some.canonical_text().starts_with("name=test\nleast_class=7\nclasses=0,5,8\n"));
    // The table's own classes do not count as a choice.
    let own = some.with_classes(&[0, 1, 2, 3, 4, 5, 6, 7]).unwrap();
    assert_eq!((&own, own.chosen_classes()), (&small(), None));
    for none in [&[][..], &[9], &[0, 200]] {
        assert_eq!(small().with_classes(none), Err(FrcTableError::Choice));
    }
}

#[test]
fn canonical_text_does_not_depend_on_the_order_of_entries() {
    let a = table(&[("motorway", 0), ("trunk", 1)], &["x", "y"], 7).unwrap();
    let b = table(&[("trunk", 1), ("motorway", 0)], &["y", "x"], 7).unwrap();
    assert_eq!(a.canonical_text(), b.canonical_text());
    assert_eq!(
        a.canonical_text(),
        "name=test\nleast_class=7\nmotorway=0\ntrunk=1\nx=not a road\ny=not a road\n"
    );
    let wider = b.with_least_class(FunctionalRoadClass::new(8).unwrap());
    assert_ne!(a.canonical_text(), wider.canonical_text());
}
