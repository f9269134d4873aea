//! The current view, as far as a command that draws it as an image needs it.

use corniche_styles::Rgb;
use corniche_viewer::{CameraRequest, ClassSet};

use crate::{
    session::Session,
    settings::{Compare, MapSettings},
};

/// The view of a window, as far as an image of the same view needs it.
#[derive(Debug, Clone, PartialEq)]
pub struct ShownView {
    /// The request for the camera; never the overview.
    pub camera: CameraRequest,
    /// Width and height of the map, pixels.
    pub size_px: [u32; 2],
    /// The settings of the map.
    pub settings: MapSettings,
    /// The name of the style.
    pub style: String,
    /// Colours of the lines of all files, in the style that is shown.
    pub overlay_colors: Vec<Rgb>,
}

/// The command line that draws a view as a picture.
pub type CommandOf = Box<dyn Fn(&ShownView) -> String>;

impl ShownView {
    /// The current view with this many line files, and a text about the parts that no command can
    /// express. `None` if the style has no name.
    #[must_use]
    pub fn from_session(session: &Session, overlays: usize) -> Option<(Self, String)> {
        let settings = &session.settings;
        let shown = Self {
            camera: session.request(),
            size_px: session.camera.size_px(),
            settings: settings.clone(),
            style: session.styles.names.get(settings.style)?.clone(),
            overlay_colors: session.overlay_colors(overlays),
        };
        let left_out: Vec<&str> = [
            (settings.roads.classes != ClassSet::ALL, "hidden classes"),
            (
                settings.width_factors.iter().any(|factor| (*factor - 1.0).abs() > 0.0),
                "width factors",
            ),
            (settings.compare != Compare::Off, "the comparison"),
        ]
        .into_iter()
        .filter_map(|(is_set, what)| is_set.then_some(what))
        .collect();
        let words = if left_out.is_empty() {
            String::new()
        } else {
            format!(" (without {})", left_out.join(", "))
        };
        Some((shown, words))
    }
}
