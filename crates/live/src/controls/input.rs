//! Inputs of a person at mouse, keys and touch screen, without any window system.

use glam::{DVec2, DVec3};

/// A button of the mouse.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Button {
    /// Left.
    Left,
    /// Middle: the wheel, pressed.
    Middle,
    /// Right.
    Right,
}

/// Keys held down with a button or another key.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Modifiers {
    /// Shift.
    pub shift: bool,
    /// Control.
    pub control: bool,
}

/// A key that moves the camera.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Key {
    /// Arrow to the left.
    Left,
    /// Arrow to the right.
    Right,
    /// Arrow up.
    Up,
    /// Arrow down.
    Down,
    /// Plus: zoom in.
    ZoomIn,
    /// Minus: zoom out.
    ZoomOut,
    /// W: fly ahead.
    Ahead,
    /// S: fly back.
    Back,
    /// A: fly to the left.
    StrafeLeft,
    /// D: fly to the right.
    StrafeRight,
    /// E: rise.
    Rise,
    /// Q: sink.
    Sink,
}

/// Whether a key goes down (or is repeated while down) or up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KeyState {
    /// Down.
    Pressed,
    /// Up.
    Released,
}

/// What a person does. Positions are pixels of the picture; (0, 0) is its upper left corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Input {
    /// A button goes down.
    Press {
        /// The button.
        button: Button,
        /// The position of the cursor.
        at_px: DVec2,
        /// The modifier keys that are held.
        modifiers: Modifiers,
    },
    /// The cursor moves, with or without a button held.
    Move {
        /// The new position of the cursor.
        at_px: DVec2,
    },
    /// A button goes up.
    Release {
        /// The button.
        button: Button,
    },
    /// Two fingers touch the map, or are elsewhere now. The first time they grab the ground between them.
    TwoFingers {
        /// Where they are.
        at_px: [DVec2; 2],
    },
    /// Less than two fingers touch the map.
    EndTwoFingers,
    /// The wheel turns.
    Wheel {
        /// Notches, or parts of one. Positive is away from the person, and zooms in.
        steps: f64,
        /// The position of the cursor.
        at_px: DVec2,
    },
    /// Two clicks with the left button.
    DoubleClick {
        /// The position of the cursor.
        at_px: DVec2,
        /// The modifier keys that are held.
        modifiers: Modifiers,
    },
    /// A key goes down or up.
    Key {
        /// The key.
        key: Key,
        /// Down or up.
        state: KeyState,
        /// The modifier keys that are held.
        modifiers: Modifiers,
    },
    /// Shift or Control went down or up.
    Modify {
        /// The modifier keys that are held now.
        modifiers: Modifiers,
    },
    /// All keys and buttons count as released: the window lost the keyboard or the mouse.
    LetGo,
    /// Turn the heading to north; the tilt stays.
    NorthUp,
    /// Back to the view at the beginning.
    Reset,
    /// Look at a place from the direction and the distance from which the middle of the picture is seen now.
    GoTo {
        /// A point of the ground, world metres.
        target_in_world: DVec3,
    },
    /// Change from map to fly mode, or back.
    ToggleFly,
    /// Change to a view straight from above with parallel rays, or back to perspective.
    ToggleAbove,
}
