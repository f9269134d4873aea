//! What a person clicked on the overlay.

use egui::Rect;

use crate::command::Command;

/// What a person clicked on the overlay, and the parts of the map on which a click is the overlay's.
#[derive(Default)]
pub(crate) struct OverlayAnswer {
    pub(crate) commands: Vec<Command>,
    pub(crate) occupied: Vec<Rect>,
}
