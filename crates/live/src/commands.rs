//! What a person asks for with a key or a button, besides other settings, and what keys mean, by
//! the names that browsers and window systems give them.

use crate::controls::{Key, Modifiers};

/// What a saved picture shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shot {
    /// The map and its credits.
    Map,
    /// All that the window shows.
    Window,
}

/// What a key or the panel does to the drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DrawingCommand {
    /// Begin to draw, or end it.
    Toggle,
    /// The next click begins another line.
    EndLine,
    /// Remove the picked point.
    RemovePoint,
    /// Remove the picked line.
    RemoveLine,
    /// Make an area of the picked line, or a line of the picked area.
    Turn,
    /// Make a curve of the picked line.
    Smooth,
    /// Take the last change back.
    Undo,
    /// Make the change again that was taken back last.
    Redo,
    /// Save the lines.
    Save,
}

/// What a person asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Command {
    /// Turn north up.
    NorthUp,
    /// Back to the first view.
    Reset,
    /// Change from map to fly mode, or back.
    ToggleFly,
    /// Change to a view straight from above, or back.
    ToggleAbove,
    /// Look at the place that is typed in the panel.
    GoTo,
    /// Put a command that draws this view on the clipboard.
    CopyView,
    /// Show the panel, or hide it.
    TogglePanel,
    /// Show the page of keys and mouse, or hide it.
    ToggleHelp,
    /// Hide the page of keys and mouse.
    CloseHelp,
    /// Save a picture.
    Take(Shot),
    /// Begin to record a flight, or end the recording.
    ToggleRecording,
    /// Begin to record a flight.
    StartRecording,
    /// End the recording and save the flight.
    StopRecording,
    /// Do something to the lines that are drawn.
    Draw(DrawingCommand),
    /// Remove the notice at this place of the list.
    Dismiss(usize),
}

/// What to do with mouse and keys in a window, and what it does.
pub const KEY_HELP: [(&str, &str); 24] = [
    ("left drag", "move the map; in fly mode look around"),
    ("right drag, Ctrl + left drag", "turn and tilt around the middle"),
    ("middle drag", "turn and tilt around the cursor"),
    ("wheel", "zoom at the cursor; in fly mode speed"),
    ("double click", "zoom in; with Shift out"),
    ("arrows", "move; with Shift turn and tilt"),
    ("+  −", "zoom by a level; with Shift by two"),
    ("R, Home", "back to the first view"),
    ("N", "north up"),
    ("F", "fly mode, and back"),
    ("T", "straight from above, and back"),
    ("W A S D, Q E", "in fly mode: fly, sink, rise"),
    ("Shift", "in fly mode: faster"),
    ("V", "copy this view as a command"),
    ("P, Shift P", "picture of the map, of the window"),
    ("C", "record the camera's way, and stop"),
    ("L, then click, Shift click", "draw lines: a point at the end, inside"),
    ("Enter, Del, Shift Del", "end the line, remove the point, the line"),
    ("G, M", "line or area, round its corners"),
    ("Ctrl Z, Ctrl Y, Ctrl S", "take back, make again, save"),
    ("Tab", "show and hide the panel"),
    ("?", "show and hide this page"),
    ("Esc", "close this page; end the line"),
    ("Ctrl Q", "close the window"),
];

impl Key {
    /// The key with this code, as the W3C names the places of keys: arrows, the keys of fly
    /// mode, and those that have + and − on many keyboards.
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

    /// The key by what is printed on it, and else by its code: arrows, + and − are told by their
    /// signs, the keys of fly mode by their position on the keyboard.
    #[must_use]
    pub fn of(sign: &str, code: &str) -> Option<Self> {
        match sign {
            "+" | "=" => Some(Self::ZoomIn),
            "-" | "_" => Some(Self::ZoomOut),
            arrow if arrow.starts_with("Arrow") => Self::of_code(arrow),
            _ => Self::of_code(code).filter(|key| key.is_for_flying()),
        }
    }

    /// Whether it means something in fly mode alone.
    #[must_use]
    pub fn is_for_flying(self) -> bool {
        matches!(
            self,
            Self::Ahead
                | Self::Back
                | Self::StrafeLeft
                | Self::StrafeRight
                | Self::Rise
                | Self::Sink
        )
    }
}

impl DrawingCommand {
    /// What a key does to drawn lines, by what is printed on it. With Control, keys of fly mode are
    /// these.
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

    /// Whether a key that is held down does it only once.
    #[must_use]
    pub fn is_once(self) -> bool {
        matches!(self, Self::Toggle | Self::Turn | Self::Smooth | Self::Save)
    }
}

impl Command {
    /// What a key asks for, by what is printed on it.
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
