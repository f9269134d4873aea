//! No displayed text controls a terminal, and JSON keeps its texts.

use super::*;

#[test]
fn what_commands_a_terminal_is_written_out() {
    assert_eq!(for_people("Höhe: 3 m\n\tsüdlich"), "Höhe: 3 m\n\tsüdlich");
    assert_eq!(for_people("a\u{1b}[31mred\rb\u{7}"), r"a\u{1b}[31mred\u{d}b\u{7}");
    assert_eq!(for_people("\u{9b}2J\u{7f}"), r"\u{9b}2J\u{7f}");
    assert_eq!(for_people("gpj.\u{202e}elif"), r"gpj.\u{202e}elif");
    // Right-to-left text is ordinary text.
    assert_eq!(for_people("דרך نهر"), "דרך نهر");
}

#[test]
fn json_says_the_same_without_such_characters() {
    let texts: Vec<String> =
        (0_u32..0x3000).filter_map(char::from_u32).map(|one| format!("a{one}b")).collect();
    let document = serde_json::to_string(&texts).unwrap();
    let shown = in_json(&document);
    assert!(!shown.contains(is_unseen));
    assert_eq!(serde_json::from_str::<Vec<String>>(&shown).unwrap(), texts);
}
