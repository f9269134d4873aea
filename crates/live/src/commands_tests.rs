//! Keys mean the same on every keyboard, in a window and in a page.

use super::*;

#[test]
fn shift_makes_a_picture_of_the_window() {
    let shift = Modifiers { shift: true, control: false };
    assert_eq!(Command::of_key("p", Modifiers::default()), Some(Command::Take(Shot::Map)));
    assert_eq!(Command::of_key("P", shift), Some(Command::Take(Shot::Window)));
    assert_eq!(Command::of_key("x", shift), None);
}

#[test]
fn a_question_mark_asks_for_help_wherever_it_is_on_the_keyboard() {
    for shift in [false, true] {
        let modifiers = Modifiers { shift, control: false };
        assert_eq!(Command::of_key("?", modifiers), Some(Command::ToggleHelp));
    }
    assert_eq!(Command::of_key("Escape", Modifiers::default()), Some(Command::CloseHelp));
}

#[test]
fn fly_mode_goes_by_the_place_of_keys_and_zoom_by_their_signs() {
    // A French keyboard has a z where an English one has a w.
    assert_eq!(Key::of("z", "KeyW"), Some(Key::Ahead));
    assert_eq!(Key::of("+", "BracketRight"), Some(Key::ZoomIn));
    assert_eq!(Key::of("ArrowUp", "Numpad8"), Some(Key::Up));
    assert_eq!(Key::of("8", "ArrowUp"), None, "a sign counts, not a position");
    assert_eq!(Key::of("´", "Equal"), None, "on a German keyboard");
    assert_eq!(Key::of_code("Equal"), Some(Key::ZoomIn), "where only the position is known");
    assert_eq!(Key::of("n", "KeyN"), None);
}

#[test]
fn with_control_keys_of_fly_mode_change_what_is_drawn() {
    let control = Modifiers { shift: false, control: true };
    assert_eq!(DrawingCommand::of_key("s", control, false), Some(DrawingCommand::Save));
    assert_eq!(DrawingCommand::of_key("s", Modifiers::default(), true), None);
    assert_eq!(DrawingCommand::of_key("Enter", control, true), Some(DrawingCommand::EndLine));
    assert_eq!(DrawingCommand::of_key("Enter", control, false), None);
}
