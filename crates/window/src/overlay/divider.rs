//! The draggable parts of the map: the divider between the two images of a split screen, with their
//! names, and points of drawn lines.

use corniche_live::{DrawingContent, MapSettings, range};
use egui::{Align2, Color32, CornerRadius, FontId, Rect, Sense, Stroke, Ui, pos2, vec2};

use super::palette::{CHALK, MARGIN, PanelActions, SLATE};

/// The divider of a split screen keeps this distance from the panel, in points.
const GRIP_ROOM: f32 = 24.0;
/// Radius of the points of drawn lines, points of the screen.
const RADIUS: f32 = 4.0;

/// Lays out the draggable divider between two images, and their names.
pub(crate) fn divider(
    ui: &mut Ui,
    rect: Rect,
    compass: Rect,
    settings: &mut MapSettings,
    answer: &mut PanelActions,
) {
    let whole = ui.ctx().viewport_rect();
    let share_at = |x: f32| (x - whole.left()) / whole.width().max(1.0);
    // A panel that opens over the divider moves it aside, because the divider could not be dragged
    // under the panel.
    let most = share_at(rect.right() - GRIP_ROOM).max(*range::DIVIDER_SHARE.start());
    settings.divider_share = settings.divider_share.min(most);
    let x = whole.left() + settings.divider_share * whole.width();
    let grip = Rect::from_min_max(pos2(x - 5.0, rect.top()), pos2(x + 5.0, rect.bottom()));
    let response = ui
        .interact(grip, ui.scope_id().with("divider"), Sense::drag())
        .on_hover_cursor(egui::CursorIcon::ResizeHorizontal);
    if let Some(pointer) = response.interact_pointer_pos().filter(|_| response.dragged()) {
        settings.divider_share = share_at(pointer.x)
            .clamp(*range::DIVIDER_SHARE.start(), most.min(*range::DIVIDER_SHARE.end()));
    }
    answer.occupied.push(grip);
    let painter = ui.painter();
    let line = |width, color| {
        painter
            .line_segment([pos2(x, rect.top()), pos2(x, rect.bottom())], Stroke::new(width, color));
    };
    line(4.0, SLATE);
    line(1.5, CHALK);
    // The names are at the upper edge, or below the text under the compass if they would cover it.
    let top = if x + 44.0 > compass.left() { compass.bottom() + 28.0 } else { rect.top() + MARGIN };
    for (words, align, dx) in [("GEO", Align2::RIGHT_TOP, -10.0), ("SV", Align2::LEFT_TOP, 10.0)] {
        let at = pos2(x + dx, top);
        let font = FontId::proportional(13.0);
        let place =
            align.anchor_size(at, painter.layout_no_wrap(words.into(), font.clone(), CHALK).size());
        painter.rect_filled(place.expand2(vec2(5.0, 2.0)), CornerRadius::same(3), SLATE);
        painter.text(at, align, words, font, CHALK);
    }
}

/// Paints the points of the lines that the user draws.
pub(crate) fn handles(ui: &Ui, drawing: &DrawingContent) {
    let painter = ui.painter();
    for handle in &drawing.handles {
        let [x, y] = handle.at;
        let (fill, radius) = if handle.is_picked {
            (Color32::from_rgb(0xFF, 0x6A, 0x00), RADIUS + 1.5)
        } else {
            (Color32::WHITE, RADIUS)
        };
        painter.circle(pos2(x, y), radius, fill, Stroke::new(1.5, Color32::from_gray(0x20)));
    }
}
