//! The compass in a corner of the map, and the button below it that opens the panel.

use corniche_live::{MapCommand, formatting};
use egui::{Align2, Color32, CornerRadius, FontId, Pos2, Rect, Stroke, Ui, Vec2, pos2, vec2};

use super::palette::{CHALK, MARGIN, PanelActions, SLATE, framed};
use crate::window_content::WindowContent;

const RADIUS: f32 = 26.0;
/// The side of the button that opens the panel, in points.
const SIDE: f32 = 28.0;
const RED: Color32 = Color32::from_rgb(206, 52, 44);

/// The position of the compass in the free part of the map.
pub(crate) fn compass_place(rect: Rect) -> Rect {
    let from_corner = MARGIN + RADIUS;
    let center = rect.right_top() + vec2(-from_corner, from_corner);
    Rect::from_center_size(center, Vec2::splat(2.0 * RADIUS))
}

/// Lays out the compass. Returns the limit of other items on the right, and its lower edge.
pub(crate) fn compass(
    ui: &mut Ui,
    area: Rect,
    content: &WindowContent<'_>,
    answer: &mut PanelActions,
) -> [f32; 2] {
    let (center, radius) = (area.center(), RADIUS);
    let hover = "Heading and pitch. Click: north up (N)";
    let response = answer.clickable(ui, (area, "compass"), hover, MapCommand::NorthUp);

    let painter = ui.painter();
    let fill = if response.hovered() { SLATE.gamma_multiply(1.2) } else { SLATE };
    painter.circle(center, radius, fill, Stroke::new(1.0, CHALK));
    // The disc of the compass lies on the ground: from a tilted camera it looks like an ellipse.
    let orientation = content.pose.orientation;
    let (sin, cos) = (orientation.heading_deg.to_radians() as f32).sin_cos();
    let flat = (orientation.pitch_deg.to_radians().cos() as f32).max(0.15);
    let on_disc = |east: f32, north: f32| {
        let (right, ahead) = (east * cos - north * sin, east * sin + north * cos);
        center + vec2(right, -ahead * flat) * (radius - 9.0)
    };
    let rim: Vec<Pos2> = (0..48)
        .map(|k| {
            let (s, c) = (k as f32 * std::f32::consts::TAU / 48.0).sin_cos();
            on_disc(s, c)
        })
        .collect();
    painter.add(egui::Shape::closed_line(rim, Stroke::new(1.0, CHALK.gamma_multiply(0.5))));
    let needle = |tip: f32, color| {
        let points = vec![on_disc(0.0, tip), on_disc(0.22, 0.0), on_disc(-0.22, 0.0)];
        painter.add(egui::Shape::convex_polygon(points, color, Stroke::NONE));
    };
    needle(-1.0, CHALK.gamma_multiply(0.7));
    needle(1.0, RED);
    let letter = center + (on_disc(0.0, 1.0) - center) * 1.0 + vec2(-sin, -cos * flat) * 6.0;
    painter.text(letter, Align2::CENTER_CENTER, "N", FontId::proportional(11.0), CHALK);

    let words =
        format!("{}  {:.0}°", formatting::heading(orientation.heading_deg), orientation.pitch_deg);
    let galley = painter.layout_no_wrap(words, FontId::proportional(11.0), CHALK);
    let size = galley.size() + vec2(10.0, 4.0);
    let plate = Rect::from_center_size(center + vec2(0.0, radius + 4.0 + size.y / 2.0), size);
    let plate = plate.translate(vec2((area.right() - plate.right()).min(0.0), 0.0));
    painter.rect_filled(plate, CornerRadius::same(4), SLATE);
    painter.galley(plate.min + vec2(5.0, 2.0), galley, CHALK);
    [area.left().min(plate.left()) - MARGIN, plate.bottom()]
}

/// Lays out the button that opens the panel, below `top` at the right edge, if there is space for
/// it.
pub(crate) fn panel_button(ui: &mut Ui, room: Rect, top: f32, answer: &mut PanelActions) {
    let corner = pos2(room.right() - MARGIN - SIDE, top + MARGIN);
    let plate = Rect::from_min_size(corner, vec2(SIDE, SIDE));
    if !room.contains_rect(plate) {
        return;
    }
    let hover = "Show the panel (Tab)";
    let response = answer.clickable(ui, (plate, "panel button"), hover, MapCommand::TogglePanel);
    let fill = if response.hovered() { SLATE.gamma_multiply(1.2) } else { SLATE };
    let painter = ui.painter();
    framed(painter, plate, fill, CHALK.gamma_multiply(0.5));
    for k in [-1.0, 0.0, 1.0] {
        let middle = plate.center() + vec2(0.0, 5.0 * k);
        let ends = [middle - vec2(7.0, 0.0), middle + vec2(7.0, 0.0)];
        painter.line_segment(ends, Stroke::new(1.5, CHALK));
    }
}
