//! Keys have their W3C names, and Ctrl Q ends the program in whose window it was pressed.

use winit::keyboard::KeyCode;

use super::*;

#[test]
fn keys_have_the_names_by_which_they_are_known() {
    let check = |logical: LogicalKey, code, expected: [&str; 2]| {
        let (sign, code) = names(&logical, PhysicalKey::Code(code));
        assert_eq!([&sign[..], &code[..]], expected);
    };
    check(LogicalKey::Character("z".into()), KeyCode::KeyW, ["z", "KeyW"]);
    for (name, code, expected) in [
        (NamedKey::ArrowLeft, KeyCode::ArrowLeft, "ArrowLeft"),
        (NamedKey::ArrowRight, KeyCode::ArrowRight, "ArrowRight"),
        (NamedKey::ArrowUp, KeyCode::ArrowUp, "ArrowUp"),
        (NamedKey::ArrowDown, KeyCode::ArrowDown, "ArrowDown"),
        (NamedKey::Home, KeyCode::Home, "Home"),
        (NamedKey::Tab, KeyCode::Tab, "Tab"),
        (NamedKey::Escape, KeyCode::Escape, "Escape"),
        (NamedKey::Enter, KeyCode::Enter, "Enter"),
        (NamedKey::Delete, KeyCode::Delete, "Delete"),
        (NamedKey::Backspace, KeyCode::Backspace, "Backspace"),
    ] {
        check(LogicalKey::Named(name), code, [expected, expected]);
    }
}

#[test]
fn control_q_ends_the_program_unless_it_was_held_down_before() {
    let control = |is_control_down| EndKey { is_control_down, is_held_from_before: false };
    assert!(control(true).press(true, false));
    assert!(!control(false).press(true, false), "a letter alone");
    let mut end_key = control(true);
    assert!(!end_key.press(true, true), "held down when the keyboard comes");
    assert!(!end_key.press(true, false), "repeated");
    assert!(!end_key.press(false, false), "let go");
    assert!(end_key.press(true, false), "and pressed here");
}
