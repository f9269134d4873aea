//! A note where the middle of the map has no ground.

use egui::{CornerRadius, FontId, Rect, Stroke, Ui, vec2};

use super::palette::{AMBER, CHALK, MARGIN, SLATE};
use corniche_live::controls::Mode;

use crate::window_content::WindowContent;

/// What is said where the middle of the map has no ground.
pub(crate) const WORDS: &str = "no data here; R returns to the first view";

/// Says that there is no ground in the middle of the map, and how to come back. In flight one may well look at the sky.
/// Returns the upper edge of what is left of the room.
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
    let stroke = Stroke::new(1.0, AMBER);
    painter.rect(plate, CornerRadius::same(4), SLATE, stroke, egui::StrokeKind::Inside);
    painter.galley(plate.min + vec2(8.0, 5.0), galley, CHALK);
    plate.bottom()
}
