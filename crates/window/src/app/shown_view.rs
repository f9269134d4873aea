//! The view as a request that `render` understands.

use corniche_live::Compare;
use corniche_viewer::ClassSet;

use super::App;
use crate::ShownView;

impl App {
    /// What is shown, and in words what no command can tell of it. `None` where the style has no name.
    pub(crate) fn shown_view(&self) -> Option<(ShownView, String)> {
        let session = &self.session;
        let settings = &session.settings;
        let shown = ShownView {
            camera: session.request(),
            size_px: session.camera.size_px(),
            roads: settings.roads,
            style: session.styles.names().get(settings.style)?.clone(),
            photo: settings.photo,
            areas: settings.areas,
            boundaries: settings.boundaries,
            hidden_overlays: settings.hidden_overlays.clone(),
            overlay_colors: self.overlay_colors(),
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
