//! Commands of keys and buttons, other than settings, and the meaning of keys by the names that
//! browsers and window systems give them.

use crate::controls::{CameraKey, Modifiers};

/// The content of a saved image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shot {
    /// The map and its attribution.
    Map,
    /// Everything that the window shows.
    Window,
}

/// A command of a key or the panel for the drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DrawingCommand {
    /// Start or stop drawing.
    Toggle,
    /// End the line: the next click starts another one.
    EndLine,
    /// Remove the selected point.
    RemovePoint,
    /// Remove the selected line.
    RemoveLine,
    /// Turn the selected line into an area, or the selected area into a line.
    Turn,
    /// Round the corners of the selected line.
    Smooth,
    /// Undo the last change.
    Undo,
    /// Redo the change that was undone last.
    Redo,
    /// Save the lines.
    Save,
}

/// A command of the user.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MapCommand {
    /// Turn north up.
    NorthUp,
    /// Return to the first view.
    Reset,
    /// Switch between map and fly mode.
    ToggleFly,
    /// Switch between perspective and a view straight from above.
    ToggleAbove,
    /// Look at the place that is typed in the panel.
    GoTo,
    /// Copy a command that draws this view to the clipboard.
    CopyView,
    /// Show or hide the panel.
    TogglePanel,
    /// Show or hide the page of keys and mouse.
    ToggleHelp,
    /// Hide the page of keys and mouse.
    CloseHelp,
    /// Save an image.
    Take(Shot),
    /// Start or stop recording a flight.
    ToggleRecording,
    /// Start recording a flight.
    StartRecording,
    /// Stop recording and save the flight.
    StopRecording,
    /// Change the drawn lines.
    Draw(DrawingCommand),
    /// Remove the notice at this index of the list.
    Dismiss(usize),
}

/// The help page: inputs of mouse and keyboard in a window, and their effects.
pub const KEY_HELP: [(&str, &str); 24] = [
    ("left drag", "move the map; in fly mode: look around"),
    ("right drag, Ctrl + left drag", "turn and tilt around the middle"),
    ("middle drag", "turn and tilt around the cursor"),
    ("wheel", "zoom at the cursor; in fly mode: speed"),
    ("double click", "zoom in; with Shift: out"),
    ("arrows", "move; with Shift: turn and tilt"),
    ("+  −", "zoom by a level; with Shift: by two"),
    ("R, Home", "back to the first view"),
    ("N", "north up"),
    ("F", "fly mode on and off"),
    ("T", "view from above on and off"),
    ("W A S D, Q E", "in fly mode: fly, sink, rise"),
    ("Shift", "in fly mode: faster"),
    ("V", "copy this view as a command"),
    ("P, Shift P", "save an image of the map, of the window"),
    ("C", "start and stop recording a flight"),
    ("L, then click, Shift click", "draw lines: add a point, insert one"),
    ("Enter, Del, Shift Del", "end line, delete point, delete line"),
    ("G, M", "line or area, round its corners"),
    ("Ctrl Z, Ctrl Y, Ctrl S", "undo, redo, save"),
    ("Tab", "show or hide the panel"),
    ("?", "show or hide this page"),
    ("Esc", "close this page; end the line"),
    ("Ctrl Q", "close the window"),
];

impl CameraKey {
    /// The key with this W3C code (its position on the keyboard): arrows, the keys of fly mode, and
    /// the keys that have + and − on many keyboards.
    #[must_use]
    pub fn of_code(code: &str) -> Option<Self> {
        Some(match code {
            "ArrowLeft" => Self::Left,
            "ArrowRight" => Self::Right,
            "ArrowUp" => Self::Up,
            "ArrowDown" => Self::Down,
            "KeyW" => Self::Ahead,
            "KeyS" => Self::Back,
            "KeyA" => Self::StrafeLeft,
            "KeyD" => Self::StrafeRight,
            "KeyE" => Self::Rise,
            "KeyQ" => Self::Sink,
            "Equal" | "NumpadAdd" => Self::ZoomIn,
            "Minus" | "NumpadSubtract" => Self::ZoomOut,
            _ => return None,
        })
    }

    /// The key by its label, or else by its code. Arrows, + and − are recognized by their labels,
    /// the keys of fly mode by their position on the keyboard.
    #[must_use]
    pub fn from_sign(sign: &str, code: &str) -> Option<Self> {
        match sign {
            "+" | "=" => Some(Self::ZoomIn),
            "-" | "_" => Some(Self::ZoomOut),
            arrow if arrow.starts_with("Arrow") => Self::of_code(arrow),
            _ => Self::of_code(code).filter(|key| key.is_for_flying()),
        }
    }

    /// Whether the key has a meaning in fly mode only.
    #[must_use]
    pub fn is_for_flying(self) -> bool {
        self >= Self::Ahead
    }
}

impl DrawingCommand {
    /// The command of a key for drawn lines, by the label of the key. With Control, keys of fly
    /// mode are commands too.
    #[must_use]
    pub fn of_key(sign: &str, modifiers: Modifiers, is_drawing: bool) -> Option<Self> {
        let Modifiers { shift, control } = modifiers;
        match sign.to_lowercase().as_str() {
            "l" if !control => Some(Self::Toggle),
            "z" if control && !shift => Some(Self::Undo),
            "z" | "y" if control => Some(Self::Redo),
            "s" if control => Some(Self::Save),
            "g" if !control && is_drawing => Some(Self::Turn),
            "m" if !control && is_drawing => Some(Self::Smooth),
            "enter" if is_drawing => Some(Self::EndLine),
            "delete" | "backspace" if is_drawing => {
                Some(if shift { Self::RemoveLine } else { Self::RemovePoint })
            }
            _ => None,
        }
    }

    /// Whether a key that is held down acts only once.
    #[must_use]
    pub fn is_once(self) -> bool {
        matches!(self, Self::Toggle | Self::Turn | Self::Smooth | Self::Save)
    }
}

impl MapCommand {
    /// The command of a key, by the label of the key.
    #[must_use]
    pub fn of_key(sign: &str, modifiers: Modifiers) -> Option<Self> {
        Some(match sign.to_lowercase().as_str() {
            "n" => Self::NorthUp,
            "r" | "home" => Self::Reset,
            "f" => Self::ToggleFly,
            "t" => Self::ToggleAbove,
            "c" => Self::ToggleRecording,
            "v" => Self::CopyView,
            "tab" => Self::TogglePanel,
            "?" => Self::ToggleHelp,
            "escape" => Self::CloseHelp,
            "p" if modifiers.shift => Self::Take(Shot::Window),
            "p" => Self::Take(Shot::Map),
            _ => return None,
        })
    }
}

#[cfg(test)]
#[path = "commands_tests.rs"]
mod tests;
