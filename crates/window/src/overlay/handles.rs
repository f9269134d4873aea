//! The points of drawn lines are painted so that a person can drag them.

use egui::{Color32, Stroke, Ui, pos2};

use crate::window_content::DrawingContent;

const RADIUS: f32 = 4.0;

/// Paints the points of the lines that a person draws.
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
