//! Every change of drawn lines can be undone.

use proptest::prelude::*;

use super::*;

fn point(x: f64) -> DrawnPoint {
    DrawnPoint { lon_lat_deg: [x, -x], at_m: [10.0 * x, x] }
}

fn places(document: &Document) -> Vec<Vec<f64>> {
    let of =
        |line: &Arc<DocumentLine>| line.points.iter().map(|point| point.lon_lat_deg[0]).collect();
    document.lines.iter().map(of).collect()
}

#[test]
fn points_are_added_moved_and_removed() {
    let mut document =
        Document::from_lines(vec![DocumentLine::new(Some(3), false, vec![point(1.0), point(2.0)])]);
    assert!(!document.is_changed(), "what was loaded is saved");
    let id = document.begin(point(5.0));
    document.insert(id, 1, point(6.0));
    document.insert(id, 1, point(5.5));
    document.shift(id, 0, point(4.0));
    assert_eq!(places(&document), [vec![1.0, 2.0], vec![4.0, 5.5, 6.0]]);
    document.remove_point(id, 1);
    document.remove_point(id, 0);
    assert_eq!(places(&document), [vec![1.0, 2.0], vec![6.0]]);
    document.remove_point(id, 0);
    assert_eq!(places(&document), [vec![1.0, 2.0]], "a line without points is gone");
    assert!(!document.is_changed(), "the lines are those that were loaded");
    let loaded = document.lines[0].id;
    document.shift(loaded, 0, point(0.5));
    assert!(document.is_changed());
    document.note_saved();
    assert!(!document.is_changed());
    document.turn(loaded);
    assert!(document.is_changed() && document.lines[0].is_area);
}

#[test]
fn what_was_taken_back_is_not_to_be_saved() {
    let mut document = Document::default();
    let id = document.begin(point(1.0));
    assert!(!document.is_changed(), "one point is no line");
    document.insert(id, 1, point(2.0));
    assert!(document.is_changed());
    document.note_saved();
    document.undo();
    assert!(document.is_changed());
    document.redo();
    assert!(!document.is_changed());
}

/// A drag is many movements but one change.
#[test]
fn a_drag_is_taken_back_at_once() {
    let mut document =
        Document::from_lines(vec![DocumentLine::new(None, false, vec![point(1.0), point(2.0)])]);
    let id = document.lines[0].id;
    document.shift(id, 0, point(3.0));
    document.shift_on(id, 0, point(4.0));
    document.shift_on(id, 0, point(5.0));
    assert_eq!(places(&document), [[5.0, 2.0]]);
    document.undo();
    assert_eq!(places(&document), [[1.0, 2.0]]);
    assert_eq!(document.can_step(), [false, true]);
    document.redo();
    assert_eq!(places(&document), [[5.0, 2.0]]);
}

#[test]
fn lines_that_are_not_changed_stay_the_same_ones() {
    let mut document = Document::from_lines(vec![
        DocumentLine::new(None, false, vec![point(1.0)]),
        DocumentLine::new(None, false, vec![point(2.0), point(3.0)]),
    ]);
    let first = Arc::clone(&document.lines[0]);
    let id = document.lines[1].id;
    document.insert(id, 2, point(4.0));
    assert!(Arc::ptr_eq(&first, &document.lines[0]));
}

proptest! {
    /// Undoing and redoing all changes leads through the same lines.
    #[test]
    fn every_change_can_be_taken_back(changes in prop::collection::vec((0_u8..5, 0_usize..6, 0.0..9.0_f64), 1..60)) {
        let mut document = Document::default();
        let mut seen = vec![places(&document)];
        for (kind, place, x) in changes {
            let line = document.lines.get(place % document.lines.len().max(1)).map(|line| line.id);
            match (kind, line) {
                (0, _) | (_, None) => { document.begin(point(x)); }
                (1, Some(id)) => document.insert(id, place, point(x)),
                (2, Some(id)) => document.shift(id, place, point(x)),
                (3, Some(id)) => document.remove_point(id, place),
                (_, Some(id)) => document.remove_line(id),
            }
            seen.push(places(&document));
        }
        for expected in seen.iter().rev().skip(1) {
            document.undo();
            prop_assert_eq!(&places(&document), expected);
        }
        prop_assert_eq!(document.can_step()[0], false);
        for expected in &seen[1..] {
            document.redo();
            prop_assert_eq!(&places(&document), expected);
        }
    }
}

#[test]
fn a_closed_line_becomes_an_area_without_its_point_twice() {
    let closed = vec![point(1.0), point(2.0), point(3.0), point(1.0)];
    let mut document = Document::from_lines(vec![DocumentLine::new(None, false, closed)]);
    let id = document.lines[0].id;
    document.turn(id);
    assert_eq!(places(&document), [vec![1.0, 2.0, 3.0]]);
    document.undo();
    assert_eq!(places(&document), [vec![1.0, 2.0, 3.0, 1.0]]);
}
