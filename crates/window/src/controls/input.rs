use glam::DVec2;

/// A button of the mouse.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Button {
    /// Left.
    Left,
    /// The wheel, pressed.
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
    /// Plus.
    ZoomIn,
    /// Minus.
    ZoomOut,
    /// W: ahead.
    Ahead,
    /// S: back.
    Back,
    /// A.
    StrafeLeft,
    /// D.
    StrafeRight,
    /// E.
    Rise,
    /// Q.
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

/// What a person does. Positions are pixels of the picture, 0, 0 its upper left corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Input {
    /// A button goes down.
    Press {
        /// Which.
        button: Button,
        /// Where.
        at_px: DVec2,
        /// With what.
        modifiers: Modifiers,
    },
    /// The cursor moves, with or without a button held.
    Move {
        /// Where to.
        at_px: DVec2,
    },
    /// A button goes up.
    Release {
        /// Which.
        button: Button,
    },
    /// The wheel turns.
    Wheel {
        /// Notches, or parts of one; away from oneself is positive and zooms in.
        steps: f64,
        /// Where.
        at_px: DVec2,
    },
    /// Two clicks with the left button.
    DoubleClick {
        /// Where.
        at_px: DVec2,
        /// With what.
        modifiers: Modifiers,
    },
    /// A key.
    Key {
        /// Which.
        key: Key,
        /// Down or up.
        state: KeyState,
        /// With what.
        modifiers: Modifiers,
    },
    /// Shift or Control went down or up.
    Modify {
        /// Those held now.
        modifiers: Modifiers,
    },
    /// Whatever is held down is let go: the window lost the keyboard or the mouse.
    LetGo,
    /// Turn north up, and keep the tilt.
    NorthUp,
    /// Back to the view at the beginning.
    Reset,
    /// From map to fly mode and back.
    ToggleFly,
}
