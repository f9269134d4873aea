//! What a caller asks of a window: package, styles, layers, and how files are written.

use std::{io, path::PathBuf};

use corniche_live::{
    CommandOf, DrawnLine, MAX_PITCH_DEG, MapSettings, NamedStyle, Reload, SaveDrawing,
};
use corniche_roads::FunctionalRoadClass;
use corniche_viewer::{CameraRequest, RoadMethod, range, stream::StreamBudget};

use crate::WindowError;

/// Opens the trace; called once, when the window is open. Each write must reach the file at once, for a script may read it
/// meanwhile.
pub type BeginTrace = Box<dyn FnOnce() -> io::Result<Box<dyn io::Write>>>;

/// How to open a window, and what it shows at first.
pub struct WindowRequest {
    /// What the package is called.
    pub name: String,
    /// Width and height of the window's inside at first, pixels.
    pub size_px: [u32; 2],
    /// Where to look from at first.
    pub camera: CameraRequest,
    /// What else a person can change, as it is at first; samples and the panel are set when it opens.
    pub settings: MapSettings,
    /// The method by which roads are drawn at first where the processor draws; `None`: by the same as elsewhere.
    pub software_method: Option<RoadMethod>,
    /// What people call the roads of each class, 0 first.
    pub class_labels: [String; FunctionalRoadClass::COUNT],
    /// Tells the command that draws a view, which a person can copy.
    pub command_of: CommandOf,
    /// Styles to choose from, at least one; the first is shown at first.
    pub styles: Vec<NamedStyle>,
    /// Tells whether the first style has changed; `None` if it cannot change.
    pub reload: Option<Reload>,
    /// What the files of lines are called that the package's tiles carry, in the order of the style's
    /// [`overlays`](corniche_styles::Style::overlays).
    pub overlays: Vec<String>,
    /// Lines that can be changed in the window.
    pub drawn_lines: Vec<DrawnLine>,
    /// Saves them.
    pub save_drawing: SaveDrawing,
    /// Samples per pixel along each side; without it 2, and 1 where the processor draws.
    pub samples_per_side: Option<u32>,
    /// What may be loaded and kept.
    pub budget: StreamBudget,
    /// Whether movements slow down gradually; else they end at once.
    pub has_inertia: bool,
    /// Where pictures and flights are saved; no existing file is replaced.
    pub folder: PathBuf,
    /// A diagnostic: opens what a line for each frame is written to.
    pub trace: Option<BeginTrace>,
    /// Called several times a second: must the program end, for instance because of a signal?
    pub is_stopped: Box<dyn Fn() -> bool>,
}

impl WindowRequest {
    /// Refuses what makes no sense, whatever the package.
    ///
    /// # Errors
    /// When a number is out of its range, or there is no style.
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
