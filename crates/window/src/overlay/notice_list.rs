//! The newest notices are laid out over the map.

use std::sync::Arc;

use egui::{Color32, CornerRadius, FontId, Galley, Rect, Sense, Stroke, Ui, Vec2, pos2, vec2};

use super::{
    answer::OverlayAnswer,
    palette::{AMBER, CHALK, MARGIN, SLATE},
};
use crate::{command::Command, notices::Notice, window_content::WindowContent};

/// Lays out the notices: the newest of them, as many as there is room for.
pub(crate) fn notices(
    ui: &mut Ui,
    room: Rect,
    content: &WindowContent<'_>,
    answer: &mut OverlayAnswer,
) {
    let mut top = room.top() + MARGIN;
    let width = (room.width() - 2.0 * MARGIN).min(460.0);
    let mut left = room.height() - MARGIN;
    let mut shown: Vec<(usize, &Notice, Arc<Galley>)> = Vec::new();
    for (place, notice) in content.notices.iter().enumerate().rev() {
        // In a text of several lines, marks point at letters of the line before: that needs letters of equal width.
        let is_drawing = notice.words.contains('\n');
        let font = if is_drawing { FontId::monospace(11.0) } else { FontId::proportional(12.5) };
        let galley = ui.painter().layout(notice.words.clone(), font, CHALK, width - 34.0);
        left -= galley.size().y + 14.0;
        if left < 0.0 {
            break;
        }
        shown.push((place, notice, galley));
    }
    for (place, notice, galley) in shown.into_iter().rev() {
        let painter = ui.painter();
        let size = vec2(galley.size().x + 34.0, galley.size().y + 10.0);
        let plate = Rect::from_min_size(pos2(room.left() + MARGIN, top), size);
        // A warning, which stays until it is dismissed, has a coloured edge.
        let edge = notice.until_s.map_or(AMBER, |_| CHALK.gamma_multiply(0.4));
        painter.rect(
            plate,
            CornerRadius::same(4),
            SLATE,
            Stroke::new(1.0, edge),
            egui::StrokeKind::Inside,
        );
        painter.galley(plate.min + vec2(8.0, 5.0), galley, CHALK);
        let cross = Rect::from_center_size(
            pos2(plate.right() - 12.0, plate.top() + 12.0),
            Vec2::splat(16.0),
        );
        let response = ui
            .interact(cross, ui.scope_id().with(("notice", place)), Sense::click())
            .on_hover_text("Dismiss");
        let ink = if response.hovered() { Color32::WHITE } else { CHALK.gamma_multiply(0.8) };
        for [x, y] in [[1.0, 1.0], [1.0, -1.0]] {
            let arm = vec2(x, y) * 4.0;
            let ends = [cross.center() - arm, cross.center() + arm];
            ui.painter().line_segment(ends, Stroke::new(1.5, ink));
        }
        if response.clicked() {
            answer.commands.push(Command::Dismiss(place));
        }
        answer.occupied.push(plate);
        top = plate.bottom() + 4.0;
    }
}
