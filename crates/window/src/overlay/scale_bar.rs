//! The lower edge of the map: its scale bar and the attribution of the package.

use std::sync::Arc;

use corniche_viewer::{bar_length, bar_length_m};
use egui::{CornerRadius, FontId, Galley, Rect, Stroke, Ui, pos2, vec2};

use super::palette::{INK, LONGEST_BAR, MARGIN, PAPER};
use crate::window_content::WindowContent;

/// From this tilt on, the scale at the edges of the image differs from that in the middle, and the
/// bar says so.
const TILTED_DEG: f64 = 5.0;

/// A length on the ground, and its length on the screen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ScaleBar {
    /// The length, metres: 1, 2 or 5 times a power of ten.
    pub(crate) length_m: f64,
    /// The length on the screen, points.
    pub(crate) points: f32,
}

impl ScaleBar {
    /// The longest bar of no more than `most` points; `None` if `metres_per_point` is not a
    /// positive number.
    pub(crate) fn new(metres_per_point: f64, most: f32) -> Option<Self> {
        let length_m = bar_length_m(metres_per_point * f64::from(most))?;
        Some(Self { length_m, points: (length_m / metres_per_point) as f32 })
    }
}

/// Paints the scale bar in the lower left corner, or above the attribution if there is no space
/// next to it. Returns the upper edge of bar and attribution.
pub(crate) fn scale_bar(
    ui: &Ui,
    rect: Rect,
    credits: Option<&Rect>,
    content: &WindowContent<'_>,
) -> f32 {
    let credits_top = credits.map_or(rect.bottom(), Rect::top);
    let most = LONGEST_BAR.min(rect.width() - 4.0 * MARGIN);
    let Some(bar) = content.metres_per_point.and_then(|scale| ScaleBar::new(scale, most)) else {
        return credits_top;
    };
    let mut words = bar_length(bar.length_m);
    if content.pose.orientation.pitch_deg > TILTED_DEG {
        words.push_str(" in the middle");
    }
    let painter = ui.painter();
    let galley = painter.layout_no_wrap(words, FontId::proportional(11.0), INK);
    let width = galley.size().x.max(bar.points) + 12.0;
    let size = vec2(width, galley.size().y + 13.0);
    let is_beside = credits.is_none_or(|place| rect.left() + size.x + MARGIN / 2.0 <= place.left());
    let bottom = if is_beside { rect.bottom() } else { credits_top - 2.0 };
    let plate = Rect::from_min_size(pos2(rect.left(), bottom - size.y), size);
    if !rect.contains_rect(plate) {
        return credits_top;
    }
    painter.rect_filled(plate, CornerRadius::ZERO, PAPER);
    painter.galley(plate.min + vec2(6.0, 2.0), galley, INK);
    let (left, base) = (plate.left() + 6.0, plate.bottom() - 4.0);
    let line = vec![
        pos2(left, base - 5.0),
        pos2(left, base),
        pos2(left + bar.points, base),
        pos2(left + bar.points, base - 5.0),
    ];
    painter.add(egui::Shape::line(line, Stroke::new(1.5, INK)));
    plate.top().min(credits_top)
}

/// The package's attribution, broken into lines: in the space next to the scale bar, or in the
/// whole width if that space is small.
fn credits_galley(ui: &Ui, rect: Rect, content: &WindowContent<'_>) -> Arc<Galley> {
    let beside = rect.width() - LONGEST_BAR - 6.0 * MARGIN;
    let room = if beside < 0.5 * rect.width() { rect.width() - 12.0 } else { beside };
    ui.painter().layout(content.attribution.join("  ·  "), FontId::proportional(11.0), INK, room)
}

/// The position of the attribution in the lower right corner; `None` if there is none.
pub(crate) fn credits_place(ui: &Ui, rect: Rect, content: &WindowContent<'_>) -> Option<Rect> {
    let size = credits_galley(ui, rect, content).size() + vec2(12.0, 6.0);
    (!content.attribution.is_empty()).then(|| Rect::from_min_max(rect.max - size, rect.max))
}

/// Paints the attribution.
pub(crate) fn credits(ui: &Ui, rect: Rect, content: &WindowContent<'_>) {
    let Some(plate) = credits_place(ui, rect, content) else { return };
    ui.painter().rect_filled(plate, CornerRadius::ZERO, PAPER);
    ui.painter().galley(plate.min + vec2(6.0, 3.0), credits_galley(ui, rect, content), INK);
}

#[cfg(test)]
#[path = "scale_bar_tests.rs"]
mod tests;
