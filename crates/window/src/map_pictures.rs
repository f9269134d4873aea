//! The pictures of the map in a window: one, or two beside each other.

use egui::TextureId;

/// The pictures of the map, as large as the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pictures {
    /// One picture.
    One(TextureId),
    /// Two pictures, left and right of the divider.
    Two([TextureId; 2]),
}
