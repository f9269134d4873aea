//! Keys mean the same on every keyboard.

use winit::keyboard::Key as Logical;

use super::*;

#[test]
fn shift_makes_a_picture_of_the_window() {
    let letter = |letter: &str| Logical::Character(letter.into());
    let shift = Modifiers { shift: true, control: false };
    assert_eq!(command(&letter("p"), Modifiers::default()), Some(Command::Take(Shot::Map)));
    assert_eq!(command(&letter("P"), shift), Some(Command::Take(Shot::Window)));
    assert_eq!(command(&letter("x"), shift), None);
}

#[test]
fn a_question_mark_asks_for_help_wherever_it_is_on_the_keyboard() {
    let mark = Logical::Character("?".into());
    for shift in [false, true] {
        let modifiers = Modifiers { shift, control: false };
        assert_eq!(command(&mark, modifiers), Some(Command::ToggleHelp));
    }
    let escape = Logical::Named(NamedKey::Escape);
    assert_eq!(command(&escape, Modifiers::default()), Some(Command::CloseHelp));
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

#[test]
fn fly_mode_goes_by_the_place_of_keys_and_zoom_by_their_signs() {
    let key =
        |sign: &str, code| moving_key(&Logical::Character(sign.into()), PhysicalKey::Code(code));
    // A French keyboard has a z where an English one has a w.
    assert_eq!(key("z", KeyCode::KeyW), Some(Key::Ahead));
    assert_eq!(key("+", KeyCode::BracketRight), Some(Key::ZoomIn));
    assert_eq!(key("n", KeyCode::KeyN), None);
}
