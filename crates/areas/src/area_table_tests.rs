//! Area tables decide by the key that they list first, and reject entries that contradict each
//! other.

use super::*;

fn table(tags: &[(&str, AreaClass)]) -> Result<AreaTable, AreaTableError> {
    AreaTable::new("t", tags.iter().map(|&(tag, class)| (tag.to_owned(), class)).collect())
}

#[test]
fn the_key_that_the_table_names_first_decides() {
    let table = table(&[
        ("natural=water", AreaClass::Water),
        ("landuse=forest", AreaClass::Forest),
        ("natural=wood", AreaClass::Forest),
    ])
    .unwrap();
    let both = [("landuse", "forest"), ("natural", "water")];
    assert_eq!(table.classify(&both), Some(AreaClass::Water));
    assert_eq!(table.classify(&[both[1], both[0]]), Some(AreaClass::Water));
    assert_eq!(
        table.classify(&[("landuse", "forest"), ("natural", "tree")]),
        Some(AreaClass::Forest)
    );
    assert_eq!(table.classify(&[("natural", "tree")]), None);
    assert_eq!(table.classify(&[]), None);
}

#[test]
fn names_its_mistakes() {
    use AreaTableError as E;
    let name = || "t".to_owned();
    let refused = |tags: &[(&str, AreaClass)]| table(tags).unwrap_err();
    let water = AreaClass::Water;
    assert_eq!(refused(&[]), E::NoTags { name: name() });
    for tag in ["natural", "=water", "natural=", "natural= water", "natural=a\u{7}"] {
        assert_eq!(refused(&[(tag, water)]), E::Tag { name: name(), tag: tag.to_owned() });
    }
    let tag = "a=b".to_owned();
    assert_eq!(
        refused(&[("a=b", water), ("a=b", AreaClass::Rock)]),
        E::Twice { name: name(), tag }
    );
    assert_eq!(refused(&[("a=b", AreaClass::Sea)]), E::Sea { name: name() });
    let bad = AreaTable::new("a b", vec![("a=b".to_owned(), water)]);
    assert_eq!(bad.unwrap_err(), E::Name { name: "a b".to_owned() });
}

#[test]
fn classes_have_numbers_and_names() {
    for (number, class) in (0..).zip(AreaClass::ALL) {
        assert_eq!(class.number(), number);
        assert_eq!(AreaClass::from_number(number), Some(class));
        assert_eq!(AreaClass::from_name(class.name()), Some(class));
    }
    assert_eq!(AreaClass::from_number(AreaClass::COUNT as u8), None);
}

#[test]
fn text_is_the_same_for_equal_tables() {
    let a = table(&[("k=b", AreaClass::Rock), ("k=a", AreaClass::Park)]).unwrap();
    let b = table(&[("k=a", AreaClass::Park), ("k=b", AreaClass::Rock)]).unwrap();
    assert_eq!(a.canonical_text(), "name=t\nk=a: park\nk=b: rock\n");
    assert_eq!(a.canonical_text(), b.canonical_text());
}
