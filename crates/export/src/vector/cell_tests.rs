//! No cell is a formula, and numbers stay numbers.

use super::*;

#[test]
fn formulas_become_texts_and_numbers_stay() {
    for (text, cell) in [
        ("=HYPERLINK(1)", "'=HYPERLINK(1)"),
        ("@SUM(A1)", "'@SUM(A1)"),
        ("+1-2", "'+1-2"),
        ("-cmd|' /C calc'!A0", "'-cmd|' /C calc'!A0"),
        ("\t=1", "'\t=1"),
        ("\r=1", "'\r=1"),
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
