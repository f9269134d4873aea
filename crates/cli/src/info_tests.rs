//! Numbers and long texts of `info` are told in a form that people read.

use super::*;

#[test]
fn sides_of_cells_are_told_to_three_digits() {
    for (cell, expected) in [
        ([63.073_2, 92.650_49], "63.1 × 92.7"),
        ([30.0, 30.0], "30"),
        ([5.0, 5.0], "5"),
        ([20.0, 30.0], "20 × 30"),
        ([0.5, 0.5], "0.5"),
        ([0.25, 0.333_333], "0.25 × 0.333"),
        ([1000.0, 1536.7], "1000 × 1537"),
        ([1e6, 0.001], "1000000 × 0.001"),
    ] {
        assert_eq!(sides(Cell::from(cell)), expected);
    }
}

#[test]
fn factors_are_told_where_there_are_any() {
    assert_eq!(factors([1.0, 1.0]), "working metres are its coordinates");
    let told = factors([-1.0, 111_180.5]);
    assert!(told.ends_with("times -1 (east) and 111180.5 (north)"), "{told}");
}

#[test]
fn long_texts_go_on_beside_their_names() {
    let words = "word ".repeat(30);
    let text = format!("datum        {words}\nwarning: {words}\n  not taken, {words}\n");
    let narrow = narrow(&text);
    assert!(narrow.lines().all(|line| line.chars().count() <= 100), "{narrow}");
    let begins: Vec<&str> = narrow.lines().map(|line| &line[..14]).collect();
    assert_eq!(
        begins,
        [
            "datum        w",
            "             w",
            "warning: word ",
            "  word word wor",
            "  not taken, w",
            "    word word "
        ]
        .map(|begin| &begin[..14])
    );
    let table = format!("a  b{}\n\n  c\n", " ".repeat(20));
    assert_eq!(super::narrow(&table), table);
}
