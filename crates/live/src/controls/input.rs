//! Inputs of mouse, keyboard and touch screen, independent of any window system.

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

/// Modifier keys held down with a button or another key.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Modifiers {
    /// Shift.
    pub shift: bool,
    /// Control.
    pub control: bool,
}

/// A key that moves the camera; the keys of fly mode come last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum CameraKey {
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

/// An input of the user. Positions are pixels of the image; (0, 0) is its upper left corner.
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
    /// Two fingers touch the map, or have moved. The first event grabs the ground between them.
    TwoFingers {
        /// The positions of the fingers.
        at_px: [DVec2; 2],
    },
    /// Fewer than two fingers touch the map.
    EndTwoFingers,
    /// The wheel turns.
    Wheel {
        /// Notches or fractions of notches. Positive values turn away from the user and zoom in.
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
        key: CameraKey,
        /// Whether it goes down, or is repeated while down.
        is_down: bool,
        /// The modifier keys that are held.
        modifiers: Modifiers,
    },
    /// Shift or Control went down or up.
    Modify {
        /// The modifier keys that are held now.
        modifiers: Modifiers,
    },
    /// All keys and buttons count as released, since the window lost the keyboard or the mouse.
    LetGo,
    /// Turn the heading to north and keep the tilt.
    NorthUp,
    /// Return to the first view.
    Reset,
    /// Look at a place from the current direction and the current distance to the middle of the
    /// image.
    GoTo {
        /// A point of the ground, world metres.
        target_in_world: DVec3,
    },
    /// Switch between map and fly mode.
    ToggleFly,
    /// Switch between perspective and a view straight from above with parallel rays.
    ToggleAbove,
}
