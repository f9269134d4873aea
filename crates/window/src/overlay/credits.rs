//! The credits of a package in the lower right corner of the map.

use std::sync::Arc;

use egui::{CornerRadius, FontId, Galley, Rect, Ui, vec2};

use super::palette::{INK, LONGEST_BAR, MARGIN, PAPER};
use crate::window_content::WindowContent;

/// The package's credits, broken into lines: in the room beside the scale bar, or in the whole width where that room is
/// small.
fn credits_galley(ui: &Ui, rect: Rect, content: &WindowContent<'_>) -> Arc<Galley> {
    let beside = rect.width() - LONGEST_BAR - 6.0 * MARGIN;
    let room = if beside < 0.5 * rect.width() { rect.width() - 12.0 } else { beside };
    ui.painter().layout(content.attribution.join("  ·  "), FontId::proportional(11.0), INK, room)
}

/// The place of the credits in the lower right corner; `None` without any.
pub(crate) fn credits_place(ui: &Ui, rect: Rect, content: &WindowContent<'_>) -> Option<Rect> {
    let size = credits_galley(ui, rect, content).size() + vec2(12.0, 6.0);
    (!content.attribution.is_empty()).then(|| Rect::from_min_max(rect.max - size, rect.max))
}

/// Paints the credits.
pub(crate) fn credits(ui: &Ui, rect: Rect, content: &WindowContent<'_>) {
    let Some(plate) = credits_place(ui, rect, content) else { return };
    ui.painter().rect_filled(plate, CornerRadius::ZERO, PAPER);
    ui.painter().galley(plate.min + vec2(6.0, 3.0), credits_galley(ui, rect, content), INK);
}
