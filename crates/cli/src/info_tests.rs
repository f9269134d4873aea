//! Numbers and long texts of `info` are readable.

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
fn errors_and_limits_have_the_same_decimals() {
    assert_eq!([0.625, 3.921_875, 1.25].map(in_metres), ["0.625", "3.922", "1.250"]);
}

#[test]
fn reasons_of_losses_are_in_words_for_people() {
    let words = |reason: LossReason| reason_words(reason.text());
    assert_eq!(words(LossReason::Listed), "not roads by the FRC table");
    assert_eq!(words(LossReason::ClassOff), "class is off");
    let all = LossReason::ALL.map(words);
    assert_eq!(std::collections::BTreeSet::from(all).len(), LossReason::ALL.len());
}

#[test]
fn long_texts_go_on_beside_their_names() {
    let words = "word ".repeat(30);
    let text = format!("datum        {words}\nwarning: {words}\n  skipped, {words}\n");
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
            "  skipped, wor",
            "    word word "
        ]
        .map(|begin| &begin[..14])
    );
    let table = format!("a  b{}\n\n  c\n", " ".repeat(20));
    assert_eq!(super::narrow(&table), table);
}
