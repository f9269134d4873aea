//! No cell is a formula or commands a terminal, and numbers stay numbers.

use super::*;

#[test]
fn formulas_become_texts_and_numbers_stay() {
    for (text, cell) in [
        ("=HYPERLINK(1)", "'=HYPERLINK(1)"),
        ("@SUM(A1)", "'@SUM(A1)"),
        ("+1-2", "'+1-2"),
        ("-cmd|' /C calc'!A0", "'-cmd|' /C calc'!A0"),
        ("\t=1", "\\u0009=1"),
        ("\r=1", "\\u000d=1"),
        ("=1\u{1b}[2J", "'=1\\u001b[2J"),
        ("a\nb", "a\\u000ab"),
        ("a\u{202e}b\u{9b}c", "a\\u202eb\\u009bc"),
        ("-", "'-"),
        ("-1", "-1"),
        ("+3.5", "+3.5"),
        ("-inf", "'-inf"),
        ("Ada's Way", "Ada's Way"),
        ("", ""),
    ] {
        assert_eq!(cell_text(text), cell);
    }
}

/// All control characters and those of the bidirectional algorithm, at the beginning, within and at
/// the end of a text: a JSON reader recovers them.
#[test]
fn what_is_not_seen_is_written_as_in_json() {
    let unseen = (0..=0x2100).filter_map(char::from_u32);
    let unseen = unseen.filter(|&one| one.is_control() || is_unseen(one));
    for character in unseen {
        for text in [format!("{character}a"), format!("a{character}b"), format!("a{character}")] {
            let line = text_in_line(&text);
            assert!(!line.contains(character), "{line:?}");
            assert_eq!(line.len(), text.len() - character.len_utf8() + 6, "{line:?}");
            let read: String = serde_json::from_str(&format!("\"{line}\"")).unwrap();
            assert_eq!(read, text);
        }
    }
}
