//! Attribution texts are plain text on one line, of limited length; texts from files are converted.

use super::*;

#[test]
fn control_characters_and_long_texts_are_no_credits() {
    for text in ["", "© swisstopo", "DEM: קרטוגרפיה, 1:25 000", &"é".repeat(1000)] {
        assert_eq!(check_credit(text), Ok(()), "{text}");
    }
    for (text, control) in
        [("a\0b", '\0'), ("a\nb", '\n'), ("\u{1b}[31m", '\u{1b}'), ("\u{85}", '\u{85}')]
    {
        assert_eq!(check_credit(text), Err(CreditError::Control(control)), "{text:?}");
    }
    assert_eq!(check_credit(&"é".repeat(1001)), Err(CreditError::Long(1001)));
    let said = CreditError::Control('\0').to_string();
    assert!(said.contains("U+0000"), "{said}");
}

#[test]
fn texts_of_files_become_credits() {
    assert_eq!(to_credit("  © A\r\n\tB\0\0 "), "© A B");
    assert_eq!(to_credit("\0\n"), "");
    let long = to_credit(&"x ".repeat(66_000));
    assert_eq!((long.chars().count(), check_credit(&long)), (1000, Ok(())));
}
