//! The texts in the upper left corner of the map: the legend of a difference, the hint that there
//! is no ground, and the newest notices.

use std::sync::Arc;

use corniche_live::{MapCommand, Notice, controls::Mode};
use corniche_viewer::gpu::{DIFFERENCE_COLORS, DifferenceColors};
use egui::{Color32, CornerRadius, FontId, Galley, Rect, Sense, Stroke, Ui, Vec2, pos2, vec2};

use super::palette::{AMBER, CHALK, LABEL_HEIGHT, MARGIN, PanelActions, SLATE, color32, framed};
use crate::window_content::WindowContent;

/// The hint that there is no ground in the middle of the map.
pub(crate) const WORDS: &str = "no data here; press R for the first view";

/// Paints the hint that there is no ground in the middle of the map, and how to return. In flight,
/// a view of the sky is normal. Returns the upper edge of the remaining space.
pub(crate) fn no_data(ui: &Ui, room: Rect, content: &WindowContent<'_>) -> f32 {
    let is_lost = content.metres_per_point.is_none() && content.tiles_drawn > 0;
    if !is_lost || content.mode == Mode::Fly {
        return room.top();
    }
    let painter = ui.painter();
    let width = (room.width() - 2.0 * MARGIN - 16.0).max(0.0);
    let galley = painter.layout(WORDS.to_owned(), FontId::proportional(13.0), CHALK, width);
    let plate =
        Rect::from_min_size(room.min + vec2(MARGIN, MARGIN), galley.size() + vec2(16.0, 10.0));
    framed(painter, plate, SLATE, AMBER);
    painter.galley(plate.min + vec2(8.0, 5.0), galley, CHALK);
    plate.bottom()
}

/// Paints the meaning of the colours of a difference. Returns the lower edge of the legend.
pub(crate) fn legend(ui: &Ui, room: Rect) -> f32 {
    let painter = ui.painter();
    let (mut left, mut top) = (room.left() + MARGIN, room.top() + MARGIN);
    let DifferenceColors { first_only, second_only, other_label } = DIFFERENCE_COLORS;
    for (words, color) in
        [("GEO only", first_only), ("SV only", second_only), ("another class", other_label)]
    {
        let galley = painter.layout_no_wrap(words.into(), FontId::proportional(12.0), CHALK);
        let size = galley.size() + vec2(28.0, 6.0);
        if left + size.x > room.right() && left > room.left() + MARGIN {
            (left, top) = (room.left() + MARGIN, top + size.y + 4.0);
        }
        let plate = Rect::from_min_size(pos2(left, top), size);
        painter.rect_filled(plate, CornerRadius::same(3), SLATE);
        let swatch =
            Rect::from_center_size(pos2(plate.left() + 12.0, plate.center().y), Vec2::splat(10.0));
        painter.rect_filled(swatch, CornerRadius::ZERO, color32(color));
        painter.galley(plate.min + vec2(22.0, 3.0), galley, CHALK);
        left = plate.right() + 4.0;
    }
    top + LABEL_HEIGHT - MARGIN
}

/// Lays out the newest notices, as many as fit.
pub(crate) fn notices(
    ui: &mut Ui,
    room: Rect,
    content: &WindowContent<'_>,
    answer: &mut PanelActions,
) {
    let mut top = room.top() + MARGIN;
    let width = (room.width() - 2.0 * MARGIN).min(460.0);
    let mut left = room.height() - MARGIN;
    let mut shown: Vec<(usize, &Notice, Arc<Galley>)> = Vec::new();
    for (place, notice) in content.notices.iter().enumerate().rev() {
        // In a text of several lines, marks point at letters of the line before: this needs a
        // monospaced font.
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
        framed(painter, plate, SLATE, edge);
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
            answer.commands.push(MapCommand::Dismiss(place));
        }
        answer.occupied.push(plate);
        top = plate.bottom() + 4.0;
    }
}
