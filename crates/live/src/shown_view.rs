//! What is seen, as far as a command that draws a picture of it needs to know.

use corniche_styles::Rgb;
use corniche_viewer::{CameraRequest, ClassSet};

use crate::{
    session::Session,
    settings::{Compare, MapSettings},
};

/// What a window shows, as far as a picture of the same view needs it.
#[derive(Debug, Clone, PartialEq)]
pub struct ShownView {
    /// Where it looks from; never the overview.
    pub camera: CameraRequest,
    /// Width and height of the map, pixels.
    pub size_px: [u32; 2],
    /// How it is shown.
    pub settings: MapSettings,
    /// The name of the style.
    pub style: String,
    /// Colours of the lines of all files, in the style that is shown.
    pub overlay_colors: Vec<Rgb>,
}

/// The command line that draws a view as a picture.
pub type CommandOf = Box<dyn Fn(&ShownView) -> String>;

impl ShownView {
    /// What is shown, with so many files of lines, and in words what no command can tell of it.
    /// `None` where the style has no name.
    #[must_use]
    pub fn of(session: &Session, overlays: usize) -> Option<(Self, String)> {
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
                "factors on widths",
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
