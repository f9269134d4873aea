//! The button that opens the panel.

use egui::{CornerRadius, Rect, Sense, Stroke, Ui, pos2, vec2};

use super::{
    answer::OverlayAnswer,
    palette::{CHALK, MARGIN, SLATE},
};
use crate::command::Command;

/// Side of the button, points.
const SIDE: f32 = 28.0;

/// Lays out the button that opens the panel, beneath `top` at the right edge, if there is room for it.
pub(crate) fn panel_button(ui: &mut Ui, room: Rect, top: f32, answer: &mut OverlayAnswer) {
    let corner = pos2(room.right() - MARGIN - SIDE, top + MARGIN);
    let plate = Rect::from_min_size(corner, vec2(SIDE, SIDE));
    if !room.contains_rect(plate) {
        return;
    }
    let response = ui
        .interact(plate, ui.scope_id().with("panel button"), Sense::click())
        .on_hover_text("Show the panel (Tab)");
    if response.clicked() {
        answer.commands.push(Command::TogglePanel);
    }
    answer.occupied.push(plate);
    let fill = if response.hovered() { SLATE.gamma_multiply(1.2) } else { SLATE };
    let painter = ui.painter();
    let stroke = Stroke::new(1.0, CHALK.gamma_multiply(0.5));
    painter.rect(plate, CornerRadius::same(4), fill, stroke, egui::StrokeKind::Inside);
    for k in [-1.0, 0.0, 1.0] {
        let middle = plate.center() + vec2(0.0, 5.0 * k);
        let ends = [middle - vec2(7.0, 0.0), middle + vec2(7.0, 0.0)];
        painter.line_segment(ends, Stroke::new(1.5, CHALK));
    }
}
