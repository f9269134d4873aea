//! Values of attributes are read from tags, and what cannot be read is counted.

use super::*;

fn read(kind: AttributeKind, tags: &[(&str, &str)]) -> (Option<AttributeValue>, usize) {
    let mut unread = 0;
    (kind.read("name", tags, || unread += 1), unread)
}

#[test]
fn texts_are_trimmed_and_odd_ones_are_counted() {
    let text = |value: &str| read(AttributeKind::Text, &[("name", value)]);
    assert_eq!(text(" Rhein "), (Some(AttributeValue::Text("Rhein".to_owned())), 0));
    assert_eq!(text(""), (None, 0));
    for odd in ["a\u{202e}b", "a\nb", &"x".repeat(256)] {
        assert_eq!(text(odd), (None, 1), "{odd:?}");
    }
    assert_eq!(read(AttributeKind::Text, &[("ref", "1")]), (None, 0));
}

#[test]
fn names_are_sorted_by_language() {
    let tags = [
        ("name:de", "Genfersee"),
        ("name", "Lac Léman"),
        ("name:left", "no language"),
        ("name:1908-1920", "old"),
        ("name:de", "second"),
        ("name:fr", "\u{200f}"),
        ("names", "another key"),
    ];
    let (names, unread) = read(AttributeKind::Names, &tags);
    let own = |pairs: &[(&str, &str)]| {
        pairs.iter().map(|&(a, b)| (a.to_owned(), b.to_owned())).collect::<Vec<_>>()
    };
    let names = names.unwrap();
    assert_eq!(names, AttributeValue::Names(own(&[("", "Lac Léman"), ("de", "Genfersee")])));
    assert_eq!(unread, 1);
    assert!(names.is_of(AttributeKind::Names) && !names.is_of(AttributeKind::Text));
    assert_eq!(names.text(&["it", "de"]), "Genfersee");
    assert_eq!(names.text(&["it"]), "Lac Léman");
}

#[test]
fn numbers_have_units_and_other_texts_are_counted() {
    let metres = |value| read(AttributeKind::Number(TagUnit::Metre), &[("name", value)]);
    assert_eq!(metres("100 ft"), (Some(AttributeValue::Number(30.48)), 0));
    assert_eq!(metres("12,345 (2019)"), (None, 1));
    let yes_no = |value| read(AttributeKind::YesNo, &[("name", value)]);
    assert_eq!(yes_no("1"), (Some(AttributeValue::YesNo(true)), 0));
    assert_eq!(yes_no("no"), (Some(AttributeValue::YesNo(false)), 0));
    assert_eq!(yes_no("maybe"), (None, 1));
    assert!(!AttributeValue::Number(f64::NAN).is_of(AttributeKind::Number(TagUnit::Metre)));
}
