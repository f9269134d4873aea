//! The legend of a picture of differences.

use corniche_viewer::gpu::{DIFFERENCE_COLORS, DifferenceColors};
use egui::{Color32, CornerRadius, FontId, Rect, Ui, Vec2, pos2, vec2};

use super::palette::{CHALK, LABEL_HEIGHT, MARGIN, SLATE};

/// Paints what the colours of a difference mean. Returns the lower edge of the legend.
pub(crate) fn legend(ui: &Ui, room: Rect) -> f32 {
    let painter = ui.painter();
    let (mut left, mut top) = (room.left() + MARGIN, room.top() + MARGIN);
    let DifferenceColors { first_only, second_only, other_label } = DIFFERENCE_COLORS;
    for (words, color) in
        [("GEO only", first_only), ("SV only", second_only), ("another class", other_label)]
    {
        let [red, green, blue] = color.map(|part| (part * 255.0).round() as u8);
        let galley = painter.layout_no_wrap(words.into(), FontId::proportional(12.0), CHALK);
        let size = galley.size() + vec2(28.0, 6.0);
        if left + size.x > room.right() && left > room.left() + MARGIN {
            (left, top) = (room.left() + MARGIN, top + size.y + 4.0);
        }
        let plate = Rect::from_min_size(pos2(left, top), size);
        painter.rect_filled(plate, CornerRadius::same(3), SLATE);
        let swatch =
            Rect::from_center_size(pos2(plate.left() + 12.0, plate.center().y), Vec2::splat(10.0));
        painter.rect_filled(swatch, CornerRadius::ZERO, Color32::from_rgb(red, green, blue));
        painter.galley(plate.min + vec2(22.0, 3.0), galley, CHALK);
        left = plate.right() + 4.0;
    }
    top + LABEL_HEIGHT - MARGIN
}
