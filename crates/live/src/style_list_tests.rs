//! The first style is checked once a second, and the others never.

use std::collections::VecDeque;

use super::*;

fn wide(outline_px: u32) -> Style {
    Style { outline_px, ..Style::road_atlas() }
}

fn named(name: &str, outline_px: u32) -> NamedStyle {
    NamedStyle { name: name.to_owned(), style: wide(outline_px) }
}

#[test]
fn a_place_behind_the_end_is_the_last_style() {
    let list = StyleList::new(vec![named("a", 1), named("b", 2)], None);
    assert_eq!(list.names, ["a", "b"]);
    let outlines = [0, 1, 9].map(|place| list.at(place).outline_px);
    assert_eq!(outlines, [1, 2, 2]);
}

#[test]
fn styles_that_cannot_change_are_never_asked_about() {
    let mut list = StyleList::new(vec![named("a", 1)], None);
    assert_eq!(list.reload_due_s(), None);
    assert_eq!(list.reload(1e6), None);
}

#[test]
fn the_first_style_is_asked_about_once_a_second_and_stays_if_it_is_broken() {
    let mut answers =
        VecDeque::from(vec![None, Some(Err("no such colour".to_owned())), Some(Ok(wide(7)))]);
    let reload: Reload = Box::new(move || answers.pop_front().expect("asked too often"));
    let mut list = StyleList::new(vec![named("a", 1), named("b", 2)], Some(reload));
    assert_eq!(list.reload(0.5), None, "too early");
    assert_eq!(list.reload(1.0), None, "unchanged");
    assert_eq!(list.reload_due_s(), Some(2.0));
    assert_eq!(list.reload(1.9), None, "too early");
    assert_eq!(list.reload(2.5), Some(Err("no such colour".to_owned())));
    assert_eq!(list.at(0).outline_px, 1);
    assert_eq!(list.reload(4.0), Some(Ok(())));
    assert_eq!([list.at(0).outline_px, list.at(1).outline_px], [7, 2]);
}
