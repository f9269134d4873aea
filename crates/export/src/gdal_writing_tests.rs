//! Texts for formats that only accept plain text.

use super::*;

#[test]
fn control_characters_of_facts_are_spaces() {
    assert_eq!(plain_text("© A\0\nB\u{9b}"), "© A  B ");
}
