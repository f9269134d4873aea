//! Texts in profile drawings fit, and describe the drawing.

use super::*;

fn leg(name: &str, reference: &str, range_m: [f64; 2]) -> ProfileLeg {
    ProfileLeg {
        way_id: 1,
        range_m,
        name: name.to_owned(),
        reference: reference.to_owned(),
        highway: "primary".to_owned(),
        structure: Structure::Ground,
    }
}

#[test]
fn names_take_the_place_of_ids_and_are_there_once_in_a_row() {
    let legs = [
        leg("Landstrasse", "16", [0.0, 10.0]),
        leg("Landstrasse", "16", [10.0, 25.0]),
        leg("", "", [25.0, 30.0]),
        leg("Im Rietle", "", [30.0, 40.0]),
        leg("", "A 1;E 60", [40.0, 50.0]),
    ];
    let expected = [
        ("Landstrasse".to_owned(), [0.0, 25.0]),
        ("Im Rietle".to_owned(), [30.0, 40.0]),
        ("A 1, E 60".to_owned(), [40.0, 50.0]),
    ];
    assert_eq!(named_stretches(&legs), expected);
}

#[test]
fn a_text_that_is_too_long_ends_with_an_ellipsis() {
    assert_eq!(shortened("Landstrasse", 11), "Landstrasse");
    assert_eq!(shortened("Landstrasse", 10), "Landstras…");
    assert_eq!(shortened("A, B, C", 5), "A, B…");
    assert_eq!(shortened("Zürcher, Öl", 9), "Zürcher…");
    assert_eq!(fitting(110, 20), 10);
    assert_eq!(fitting(-3, 20), 0);
}

#[test]
fn numbers_at_axes_have_the_decimals_that_they_need() {
    assert_eq!([475.0, 0.5, 0.125, -4.0, -0.0].map(tick), ["475", "0.5", "0.125", "−4", "0"]);
}

/// A deck of two vertices between level roads: its grade over 50 m begins at its start, not only at
/// its middle.
#[test]
fn the_grade_is_drawn_between_vertices_too() {
    let line = [(0.0, 100.0), (1.0, 100.0), (2.0, 150.0), (3.0, 150.0)];
    let drawn = grade_line(&line, 0.05, 3.0);
    assert_eq!(drawn.len(), 1001);
    for (at_km, grade_pct) in drawn {
        // From level to 5 % within 50 m around the vertices.
        let expected = 100.0
            * ((at_km - 1.0 + 0.025).clamp(0.0, 0.05) - (at_km - 2.0 + 0.025).clamp(0.0, 0.05));
        assert!((grade_pct - expected).abs() < 1e-9, "{at_km}: {grade_pct} {expected}");
    }
    assert_eq!(grade_line(&line[..2], 5.0, 1.0).first(), Some(&(0.0, 0.0)));
    assert_eq!(grade_line(&[], 0.05, 1.0), []);
}
