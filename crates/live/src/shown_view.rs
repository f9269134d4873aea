//! What is seen, as far as a command that draws a picture of it needs to know.

use std::collections::BTreeSet;

use corniche_styles::Rgb;
use corniche_viewer::{CameraRequest, ClassSet, RoadOptions, Wireframe};

use crate::{
    session::Session,
    settings::{Compare, Visibility},
};

/// What a window shows, as far as a picture of the same view needs it.
#[derive(Debug, Clone, PartialEq)]
pub struct ShownView {
    /// Where it looks from; never the overview.
    pub camera: CameraRequest,
    /// Width and height of the map, pixels.
    pub size_px: [u32; 2],
    /// How roads are drawn.
    pub roads: RoadOptions,
    /// The name of the style.
    pub style: String,
    /// How strongly photos are seen, 0 to 1; `None`: as the style says.
    pub photo: Option<f32>,
    /// Whether areas are drawn as the style says, or not at all.
    pub areas: Visibility,
    /// Whether boundaries are drawn as the style says, or not at all.
    pub boundaries: Visibility,
    /// Files of lines that are hidden, by their numbers.
    pub hidden_overlays: BTreeSet<usize>,
    /// Colours of the lines of all files, in the style that is shown.
    pub overlay_colors: Vec<Rgb>,
    /// Factor on heights.
    pub exaggeration: f64,
    /// A tile is refined while its error looks larger than this, pixels.
    pub screen_space_error_px: f64,
    /// A tile is refined while one of its cells looks larger than this, pixels.
    pub cell_px: f64,
    /// Samples per pixel along each side.
    pub samples_per_side: u32,
    /// Whether edges of triangles are drawn.
    pub wireframe: Wireframe,
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
            roads: settings.roads,
            style: session.styles.names().get(settings.style)?.clone(),
            photo: settings.photo,
            areas: settings.areas,
            boundaries: settings.boundaries,
            hidden_overlays: settings.hidden_overlays.clone(),
            overlay_colors: session.overlay_colors(overlays),
            exaggeration: settings.exaggeration,
            screen_space_error_px: settings.screen_space_error_px,
            cell_px: settings.cell_px,
            samples_per_side: settings.samples_per_side,
            wireframe: settings.wireframe(),
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
