//! Keys have the same meaning on every keyboard, in a window and in a page.

use super::*;

#[test]
fn shift_makes_a_picture_of_the_window() {
    let shift = Modifiers { shift: true, control: false };
    assert_eq!(MapCommand::of_key("p", Modifiers::default()), Some(MapCommand::Take(Shot::Map)));
    assert_eq!(MapCommand::of_key("P", shift), Some(MapCommand::Take(Shot::Window)));
    assert_eq!(MapCommand::of_key("x", shift), None);
}

#[test]
fn a_question_mark_asks_for_help_wherever_it_is_on_the_keyboard() {
    for shift in [false, true] {
        let modifiers = Modifiers { shift, control: false };
        assert_eq!(MapCommand::of_key("?", modifiers), Some(MapCommand::ToggleHelp));
    }
    assert_eq!(MapCommand::of_key("Escape", Modifiers::default()), Some(MapCommand::CloseHelp));
}

#[test]
fn fly_mode_goes_by_the_place_of_keys_and_zoom_by_their_signs() {
    // A French keyboard has a z where an English one has a w.
    assert_eq!(CameraKey::from_sign("z", "KeyW"), Some(CameraKey::Ahead));
    assert_eq!(CameraKey::from_sign("+", "BracketRight"), Some(CameraKey::ZoomIn));
    assert_eq!(CameraKey::from_sign("ArrowUp", "Numpad8"), Some(CameraKey::Up));
    assert_eq!(CameraKey::from_sign("8", "ArrowUp"), None, "a sign counts, not a position");
    assert_eq!(CameraKey::from_sign("´", "Equal"), None, "on a German keyboard");
    assert_eq!(
        CameraKey::of_code("Equal"),
        Some(CameraKey::ZoomIn),
        "where only the position is known"
    );
    assert_eq!(CameraKey::from_sign("n", "KeyN"), None);
}

#[test]
fn with_control_keys_of_fly_mode_change_what_is_drawn() {
    let control = Modifiers { shift: false, control: true };
    assert_eq!(DrawingCommand::of_key("s", control, false), Some(DrawingCommand::Save));
    assert_eq!(DrawingCommand::of_key("s", Modifiers::default(), true), None);
    assert_eq!(DrawingCommand::of_key("Enter", control, true), Some(DrawingCommand::EndLine));
    assert_eq!(DrawingCommand::of_key("Enter", control, false), None);
}
