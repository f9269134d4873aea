//! Texts for formats that take plain text alone.

use super::*;

#[test]
fn control_characters_of_facts_are_spaces_and_values_keep_all_but_nul() {
    assert_eq!(plain_text("© A\0\nB\u{9b}"), "© A  B ");
    assert_eq!(without_nul("A\0\nB"), "A\u{fffd}\nB");
}
