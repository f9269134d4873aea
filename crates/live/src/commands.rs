//! What a person asks for with a key or a button of the panel, besides other settings.

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
