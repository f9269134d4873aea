//! The request for a window: package, styles, layers, and the writing of files.

use std::{io, path::PathBuf};

use corniche_live::{
    CommandOf, DrawnLine, MAX_PITCH_DEG, MapSettings, NamedStyle, Reload, SaveDrawing,
};
use corniche_roads::FunctionalRoadClass;
use corniche_viewer::{CameraRequest, RoadMethod, range, stream::StreamBudget};

use crate::WindowError;

/// Opens the trace; called once, when the window is open. Each write must reach the file at once,
/// because a script may read it meanwhile.
pub type BeginTrace = Box<dyn FnOnce() -> io::Result<Box<dyn io::Write>>>;

/// The request for a window, with its initial state.
pub struct WindowRequest {
    /// The name of the package.
    pub name: String,
    /// The initial width and height of the window's inside, in pixels.
    pub size_px: [u32; 2],
    /// The initial camera.
    pub camera: CameraRequest,
    /// The other initial settings; the window sets samples and the panel when it opens.
    pub settings: MapSettings,
    /// The initial drawing method of roads if the CPU draws; `None` for the same as on a GPU.
    pub software_method: Option<RoadMethod>,
    /// The names of the classes, class 0 first.
    pub class_labels: [String; FunctionalRoadClass::COUNT],
    /// Returns the command that draws a view, which the user can copy.
    pub command_of: CommandOf,
    /// Styles to choose from, at least one; the first is the initial one.
    pub styles: Vec<NamedStyle>,
    /// Checks whether the first style has changed; `None` if it cannot change.
    pub reload: Option<Reload>,
    /// The names of the line files in the package's tiles, in the order of the style's
    /// [`overlays`](corniche_styles::Style::overlays).
    pub overlays: Vec<String>,
    /// Lines that can be changed in the window.
    pub drawn_lines: Vec<DrawnLine>,
    /// Saves the lines.
    pub save_drawing: SaveDrawing,
    /// Samples per pixel along each side; `None` for 2, or 1 if the CPU draws.
    pub samples_per_side: Option<u32>,
    /// The limits of tiles being loaded and kept.
    pub budget: StreamBudget,
    /// Whether movements slow down gradually; otherwise they end at once.
    pub has_inertia: bool,
    /// The folder for saved images and flights; existing files are never overwritten.
    pub folder: PathBuf,
    /// Opens the trace, a diagnostic file with one line per frame.
    pub trace: Option<BeginTrace>,
    /// Returns whether the program must end, for example because of a signal; called several times
    /// a second.
    pub is_stopped: Box<dyn Fn() -> bool>,
}

impl WindowRequest {
    /// Rejects invalid values, whatever the package.
    ///
    /// # Errors
    /// When a number is out of range, or there is no style.
    pub(crate) fn check(&self) -> Result<(), WindowError> {
        if self.styles.is_empty() {
            return Err(WindowError::NoStyle);
        }
        let MapSettings { screen_space_error_px, cell_px, exaggeration, .. } = self.settings;
        range::check_ground(screen_space_error_px, cell_px, exaggeration)?;
        if let Some(samples) = self.samples_per_side {
            range::check_supersampling(samples)?;
        }
        let [width, height] = self.size_px;
        let least = f64::from(width.min(height));
        range::within("a window's side", least, 1.0..=f64::MAX, "at least 1 pixel")?;
        range::check_camera(self.camera)?;
        let pitch_deg = self.camera.orientation().pitch_deg;
        range::within("a pitch", pitch_deg, 0.0..=MAX_PITCH_DEG, "0 (straight down) to 85")?;
        Ok(())
    }
}
