//! What lies on the map itself: compass, scale bar, credits, notices, the divider of a split screen, and the line of
//! positions below.
//!
//! Everything is painted at its place in the map's free part, without windows of its own, so that nothing moves, fades
//! or covers anything else.

use corniche_viewer::gpu::{DIFFERENCE_COLORS, DifferenceColors};
use egui::{
    Align2, Color32, CornerRadius, FontId, Pos2, Rect, Sense, Stroke, Ui, Vec2, pos2, vec2,
};

use crate::{
    controls::Mode,
    facts::{Command, Facts},
    settings::{Compare, Settings, range},
    words,
};

const MARGIN: f32 = 8.0;
const COMPASS_RADIUS: f32 = 26.0;
/// A scale bar is no longer than this, points.
const LONGEST_BAR: f32 = 160.0;
/// Credits and scale bar are on paper: dark on light, over any style of map.
const PAPER: Color32 = Color32::from_rgba_premultiplied(214, 214, 214, 214);
const INK: Color32 = Color32::from_rgb(24, 28, 32);
const SLATE: Color32 = Color32::from_rgba_premultiplied(22, 24, 28, 225);
const CHALK: Color32 = Color32::from_rgb(236, 238, 240);
const RED: Color32 = Color32::from_rgb(206, 52, 44);
/// From this tilt on the scale at the middle of the picture is not that of its edges.
const TILTED_DEG: f64 = 5.0;

/// What is on the map, and which parts of it a click is not meant for.
#[derive(Default)]
pub(crate) struct Overlay {
    pub(crate) commands: Vec<Command>,
    pub(crate) occupied: Vec<Rect>,
}

/// The line of positions at the lower edge of the window.
pub(crate) fn status_line(ui: &mut Ui, facts: &Facts<'_>) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 14.0;
        let small = |text: String| egui::RichText::new(text).size(12.0);
        match &facts.cursor {
            Some(point) => {
                let [x, y, height_m] = point.at_m;
                ui.label(small(words::position(point.lon_lat_deg)));
                ui.label(small(format!("{}  {x:.1}  {y:.1}", facts.crs)));
                ui.label(small(format!("ground {height_m:.1} m")));
            }
            None => {
                ui.label(small("no ground under the cursor".to_owned()));
            }
        }
        let orientation = facts.pose.orientation;
        ui.label(small(format!("eye {}", words::length(facts.pose.eye_m[2]))));
        ui.label(small(format!("heading {}", words::heading(orientation.heading_deg))));
        ui.label(small(format!("pitch {:.0}°", orientation.pitch_deg)));
        if facts.mode == Mode::Fly {
            ui.label(small("fly mode: W A S D, Q E, Shift; F ends it".to_owned()).strong());
        }
        if facts.tiles_missing > 0 {
            ui.label(small(format!("loading {} tiles", facts.tiles_missing)));
        }
    });
}

/// Everything on the map; `rect` is the part of it that the panel leaves free.
pub(crate) fn overlay(
    ui: &mut Ui,
    rect: Rect,
    settings: &mut Settings,
    facts: &Facts<'_>,
) -> Overlay {
    let mut overlay = Overlay::default();
    if settings.compare == Compare::Split {
        divider(ui, rect, settings, &mut overlay);
    }
    if settings.compare == Compare::Difference {
        legend(ui, rect);
    }
    let credits_left = credits(ui, rect, facts);
    scale_bar(ui, rect, credits_left, facts);
    let compass_left = compass(ui, rect, facts, &mut overlay);
    let notices_below =
        if settings.compare == Compare::Off { rect.top() } else { rect.top() + 30.0 };
    let room =
        Rect::from_min_max(pos2(rect.left(), notices_below), pos2(compass_left, rect.bottom()));
    notices(ui, room, facts, &mut overlay);
    overlay
}

/// Returns where its left edge is.
fn compass(ui: &mut Ui, rect: Rect, facts: &Facts<'_>, overlay: &mut Overlay) -> f32 {
    let radius = COMPASS_RADIUS;
    let center = pos2(rect.right() - MARGIN - radius, rect.top() + MARGIN + radius);
    let area = Rect::from_center_size(center, Vec2::splat(2.0 * radius));
    let response = ui
        .interact(area, ui.scope_id().with("compass"), Sense::click())
        .on_hover_text("Click: north up (N)");
    if response.clicked() {
        overlay.commands.push(Command::NorthUp);
    }
    overlay.occupied.push(area);

    let painter = ui.painter();
    let fill = if response.hovered() { SLATE.gamma_multiply(1.2) } else { SLATE };
    painter.circle(center, radius, fill, Stroke::new(1.0, CHALK));
    // The disc lies on the ground: tilted, it is seen as an ellipse.
    let orientation = facts.pose.orientation;
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
        format!("{}  {:.0}°", words::heading(orientation.heading_deg), orientation.pitch_deg);
    let galley = painter.layout_no_wrap(words, FontId::proportional(11.0), CHALK);
    let size = galley.size() + vec2(10.0, 4.0);
    let plate = Rect::from_center_size(center + vec2(0.0, radius + 4.0 + size.y / 2.0), size);
    let plate = plate.translate(vec2((rect.right() - MARGIN - plate.right()).min(0.0), 0.0));
    painter.rect_filled(plate, CornerRadius::same(4), SLATE);
    painter.galley(plate.min + vec2(5.0, 2.0), galley, CHALK);
    area.left().min(plate.left()) - MARGIN
}

/// The package's credits in the lower right corner. Returns where their left edge is.
fn credits(ui: &Ui, rect: Rect, facts: &Facts<'_>) -> f32 {
    let painter = ui.painter();
    let room = (rect.width() - LONGEST_BAR - 6.0 * MARGIN).max(0.5 * rect.width());
    let galley =
        painter.layout(facts.attribution.join("  ·  "), FontId::proportional(11.0), INK, room);
    if facts.attribution.is_empty() {
        return rect.right();
    }
    let size = galley.size() + vec2(12.0, 6.0);
    let plate = Rect::from_min_max(rect.max - size, rect.max);
    painter.rect_filled(plate, CornerRadius::ZERO, PAPER);
    painter.galley(plate.min + vec2(6.0, 3.0), galley, INK);
    plate.left()
}

/// A length on the ground and how long it is on the screen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ScaleBar {
    /// Metres: 1, 2 or 5 and zeros.
    pub(crate) length_m: f64,
    /// Points of the screen.
    pub(crate) points: f32,
}

impl ScaleBar {
    /// The longest one of no more than `most` points; `None` when a point is no length.
    pub(crate) fn new(metres_per_point: f64, most: f32) -> Option<Self> {
        let most_m = metres_per_point * f64::from(most);
        // Not a number is not positive either.
        if !(most_m > 0.0 && most_m.is_finite()) {
            return None;
        }
        let power = 10_f64.powf(most_m.log10().floor());
        let step = [5.0, 2.0, 1.0].into_iter().find(|step| step * power <= most_m).unwrap_or(1.0);
        let length_m = step * power;
        Some(Self { length_m, points: (length_m / metres_per_point) as f32 })
    }
}

fn scale_bar(ui: &Ui, rect: Rect, right: f32, facts: &Facts<'_>) {
    let most = LONGEST_BAR.min(right - rect.left() - 4.0 * MARGIN);
    let Some(bar) = facts.metres_per_point.and_then(|scale| ScaleBar::new(scale, most)) else {
        return;
    };
    let mut words = words::round_length(bar.length_m);
    if facts.pose.orientation.pitch_deg > TILTED_DEG {
        words.push_str(" in the middle");
    }
    let painter = ui.painter();
    let galley = painter.layout_no_wrap(words, FontId::proportional(11.0), INK);
    let width = galley.size().x.max(bar.points) + 12.0;
    let size = vec2(width, galley.size().y + 13.0);
    let plate = Rect::from_min_size(pos2(rect.left(), rect.bottom() - size.y), size);
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
}

fn notices(ui: &mut Ui, room: Rect, facts: &Facts<'_>, overlay: &mut Overlay) {
    let mut top = room.top() + MARGIN;
    let width = (room.width() - 2.0 * MARGIN).min(460.0);
    for (place, notice) in facts.notices.iter().enumerate() {
        let painter = ui.painter();
        let galley =
            painter.layout(notice.clone(), FontId::proportional(12.5), CHALK, width - 34.0);
        let size = vec2(galley.size().x + 34.0, galley.size().y + 10.0);
        let plate = Rect::from_min_size(pos2(room.left() + MARGIN, top), size);
        painter.rect(
            plate,
            CornerRadius::same(4),
            SLATE,
            Stroke::new(1.0, Color32::from_rgb(214, 160, 60)),
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
            overlay.commands.push(Command::Dismiss(place));
        }
        overlay.occupied.push(plate);
        top = plate.bottom() + 4.0;
    }
}

/// What the colours of a difference mean.
fn legend(ui: &Ui, rect: Rect) {
    let painter = ui.painter();
    let mut left = rect.left() + MARGIN;
    let DifferenceColors { first_only, second_only, other_label } = DIFFERENCE_COLORS;
    for (words, color) in
        [("GEO only", first_only), ("SV only", second_only), ("another class", other_label)]
    {
        let [red, green, blue] = color.map(|part| (part * 255.0).round() as u8);
        let galley = painter.layout_no_wrap(words.into(), FontId::proportional(12.0), CHALK);
        let size = galley.size() + vec2(28.0, 6.0);
        let plate = Rect::from_min_size(pos2(left, rect.top() + MARGIN), size);
        painter.rect_filled(plate, CornerRadius::same(3), SLATE);
        let swatch =
            Rect::from_center_size(pos2(plate.left() + 12.0, plate.center().y), Vec2::splat(10.0));
        painter.rect_filled(swatch, CornerRadius::ZERO, Color32::from_rgb(red, green, blue));
        painter.galley(plate.min + vec2(22.0, 3.0), galley, CHALK);
        left = plate.right() + 4.0;
    }
}

/// Two pictures side by side, and the line between them, which can be dragged.
fn divider(ui: &mut Ui, rect: Rect, settings: &mut Settings, overlay: &mut Overlay) {
    let whole = ui.ctx().viewport_rect();
    let x = whole.left() + settings.divider_share * whole.width();
    let grip = Rect::from_min_max(pos2(x - 5.0, rect.top()), pos2(x + 5.0, rect.bottom()));
    let response = ui
        .interact(grip, ui.scope_id().with("divider"), Sense::drag())
        .on_hover_cursor(egui::CursorIcon::ResizeHorizontal);
    if let Some(pointer) = response.interact_pointer_pos().filter(|_| response.dragged()) {
        let share = (pointer.x - whole.left()) / whole.width().max(1.0);
        settings.divider_share =
            share.clamp(*range::DIVIDER_SHARE.start(), *range::DIVIDER_SHARE.end());
    }
    overlay.occupied.push(grip);
    let painter = ui.painter();
    let line = |width, color| {
        painter
            .line_segment([pos2(x, rect.top()), pos2(x, rect.bottom())], Stroke::new(width, color));
    };
    line(4.0, SLATE);
    line(1.5, CHALK);
    for (words, align, dx) in [("GEO", Align2::RIGHT_TOP, -10.0), ("SV", Align2::LEFT_TOP, 10.0)] {
        let at = pos2(x + dx, rect.top() + MARGIN);
        let font = FontId::proportional(13.0);
        let place =
            align.anchor_size(at, painter.layout_no_wrap(words.into(), font.clone(), CHALK).size());
        painter.rect_filled(place.expand2(vec2(5.0, 2.0)), CornerRadius::same(3), SLATE);
        painter.text(at, align, words, font, CHALK);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scale_bars_are_the_longest_of_one_two_five_that_fit() {
        let check = |metres_per_point, most, length_m: f64, points: f32| {
            let bar = ScaleBar::new(metres_per_point, most).unwrap();
            assert!((bar.length_m / length_m - 1.0).abs() < 1e-9, "{bar:?}");
            assert!((bar.points - points).abs() < 1e-3 && bar.points <= most, "{bar:?}");
        };
        check(1.0, 160.0, 100.0, 100.0);
        check(1.0, 200.0, 200.0, 200.0);
        check(3.0, 160.0, 200.0, 66.666_67);
        check(3.2, 160.0, 500.0, 156.25);
        check(0.001, 160.0, 0.1, 100.0);
        check(70.0, 160.0, 10_000.0, 142.857_15);
    }

    #[test]
    fn without_a_scale_there_is_no_bar() {
        for metres_per_point in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(ScaleBar::new(metres_per_point, 160.0), None);
        }
        assert_eq!(ScaleBar::new(1.0, -20.0), None);
    }
}
