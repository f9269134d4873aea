//! What lies on the map itself: compass, scale bar, credits, notices, the divider of a split screen, and the line of
//! positions below.
//!
//! Everything is painted at its place in the map's free part, without windows of its own, so that nothing moves, fades
//! or covers anything else.

use std::sync::Arc;

use corniche_viewer::gpu::{DIFFERENCE_COLORS, DifferenceColors};
use egui::{
    Align2, Color32, CornerRadius, FontId, Galley, Pos2, Rect, Sense, Stroke, Ui, Vec2, pos2, vec2,
};

use crate::{
    controls::Mode,
    facts::{Command, Facts},
    notices::Notice,
    panel::PanelRoom,
    settings::{Compare, Settings, range},
    words,
};

/// A window without so much room leaves the milliseconds out of the status line, points.
const PASSES_WIDTH: f32 = 600.0;
const MARGIN: f32 = 8.0;
const COMPASS_RADIUS: f32 = 26.0;
/// A map of less than so much on a side shows nothing on it but credits and scale.
const SMALL: f32 = 110.0;
/// What a row of labels at the upper edge takes.
const LABEL_HEIGHT: f32 = 30.0;
/// The divider of a split screen stays so far from the panel.
const GRIP_ROOM: f32 = 24.0;
/// A scale bar is no longer than this, points.
const LONGEST_BAR: f32 = 160.0;
/// Credits and scale bar are on paper: dark on light, over any style of map.
const PAPER: Color32 = Color32::from_rgba_premultiplied(214, 214, 214, 214);
const INK: Color32 = Color32::from_rgb(24, 28, 32);
const SLATE: Color32 = Color32::from_rgba_premultiplied(22, 24, 28, 225);
const CHALK: Color32 = Color32::from_rgb(236, 238, 240);
const AMBER: Color32 = Color32::from_rgb(214, 160, 60);
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
pub(crate) fn status_line(ui: &mut Ui, facts: &Facts<'_>, panel: PanelRoom) {
    // Small windows have room for the map or for these; the panel has them too.
    let has_room = ui.available_width() >= PASSES_WIDTH;
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 14.0;
        let small = |text: String| egui::RichText::new(text).size(12.0);
        // A line ends between two items, not in the midst of one.
        let mut tell = |text: egui::RichText| ui.add(egui::Label::new(text).extend());
        match &facts.cursor {
            Some(point) => {
                let [x, y, height_m] = point.at_m;
                tell(small(words::position(point.lon_lat_deg)));
                tell(small(words::coordinates(facts.crs, [x, y])));
                tell(small(format!("ground {height_m:.1} m")));
            }
            None => {
                tell(small("no ground under the cursor".to_owned()));
            }
        }
        let orientation = facts.pose.orientation;
        tell(small(format!("eye {}", words::length(facts.pose.eye_m[2]))));
        tell(small(format!("heading {}", words::heading(orientation.heading_deg))));
        tell(small(format!("pitch {:.0}°", orientation.pitch_deg)));
        let passes = if has_room { facts.passes } else { &[] };
        for (method, times) in passes {
            let [terrain_ms, roads_ms, composite_ms] =
                [times.terrain_ms, times.roads_ms, times.composite_ms];
            let method = words::method(*method);
            tell(small(format!(
                "{method}: terrain {terrain_ms:.1}, roads {roads_ms:.1}, composite {composite_ms:.1} ms"
            )));
        }
        if let Some(recording_s) = facts.recording_s {
            let words = format!("recording for {recording_s:.0} s");
            tell(small(words).color(Color32::from_rgb(255, 140, 120)));
        }
        if facts.mode == Mode::Fly {
            tell(small("fly mode: W A S D, Q E, Shift; F ends it".to_owned()).strong());
        }
        if facts.is_full {
            tell(small(format!("{} tiles find no room", facts.tiles_missing)));
        } else if facts.tiles_missing > 0 {
            tell(small(format!("loading {} tiles", facts.tiles_missing)));
        }
        if panel == PanelRoom::TooLittle {
            tell(small("a wider window shows the panel".to_owned()));
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
    // None of it lies on the panel or the line of positions, however small the window is.
    ui.set_clip_rect(rect);
    let mut room = rect;
    room.max.y = scale_bar(ui, rect, credits_place(ui, rect, facts).as_ref(), facts);
    if room.width() > SMALL && room.height() > SMALL {
        let place = compass_place(rect);
        if settings.compare == Compare::Split {
            divider(ui, rect, place, settings, &mut overlay);
            room.min.y += LABEL_HEIGHT;
        }
        room.max.x = compass(ui, place, facts, &mut overlay);
        if settings.compare == Compare::Difference {
            room.min.y = legend(ui, room);
        }
        notices(ui, room, facts, &mut overlay);
    }
    // Last, and so on top of anything else.
    credits(ui, rect, facts);
    overlay
}

/// Where the compass is in the map's free part.
fn compass_place(rect: Rect) -> Rect {
    let from_corner = MARGIN + COMPASS_RADIUS;
    let center = rect.right_top() + vec2(-from_corner, from_corner);
    Rect::from_center_size(center, Vec2::splat(2.0 * COMPASS_RADIUS))
}

/// Returns where its left edge is.
fn compass(ui: &mut Ui, area: Rect, facts: &Facts<'_>, overlay: &mut Overlay) -> f32 {
    let (center, radius) = (area.center(), COMPASS_RADIUS);
    let response = ui
        .interact(area, ui.scope_id().with("compass"), Sense::click())
        .on_hover_text("Heading and pitch. Click: north up (N)");
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
    let plate = plate.translate(vec2((area.right() - plate.right()).min(0.0), 0.0));
    painter.rect_filled(plate, CornerRadius::same(4), SLATE);
    painter.galley(plate.min + vec2(5.0, 2.0), galley, CHALK);
    area.left().min(plate.left()) - MARGIN
}

/// The package's credits as they are set: beside the scale bar, or in all the width where that is little.
fn credits_galley(ui: &Ui, rect: Rect, facts: &Facts<'_>) -> Arc<Galley> {
    let beside = rect.width() - LONGEST_BAR - 6.0 * MARGIN;
    let room = if beside < 0.5 * rect.width() { rect.width() - 12.0 } else { beside };
    ui.painter().layout(facts.attribution.join("  ·  "), FontId::proportional(11.0), INK, room)
}

/// The lower right corner, where the credits are; `None` without any.
fn credits_place(ui: &Ui, rect: Rect, facts: &Facts<'_>) -> Option<Rect> {
    let size = credits_galley(ui, rect, facts).size() + vec2(12.0, 6.0);
    (!facts.attribution.is_empty()).then(|| Rect::from_min_max(rect.max - size, rect.max))
}

fn credits(ui: &Ui, rect: Rect, facts: &Facts<'_>) {
    let Some(plate) = credits_place(ui, rect, facts) else { return };
    ui.painter().rect_filled(plate, CornerRadius::ZERO, PAPER);
    ui.painter().galley(plate.min + vec2(6.0, 3.0), credits_galley(ui, rect, facts), INK);
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

/// In the lower left corner, or above the credits where there is no room beside them. Returns where what lies below
/// everything else begins.
fn scale_bar(ui: &Ui, rect: Rect, credits: Option<&Rect>, facts: &Facts<'_>) -> f32 {
    let credits_top = credits.map_or(rect.bottom(), Rect::top);
    let most = LONGEST_BAR.min(rect.width() - 4.0 * MARGIN);
    let Some(bar) = facts.metres_per_point.and_then(|scale| ScaleBar::new(scale, most)) else {
        return credits_top;
    };
    let mut words = words::round_length(bar.length_m);
    if facts.pose.orientation.pitch_deg > TILTED_DEG {
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

/// As many as there is room for, the newest of them.
fn notices(ui: &mut Ui, room: Rect, facts: &Facts<'_>, overlay: &mut Overlay) {
    let mut top = room.top() + MARGIN;
    let width = (room.width() - 2.0 * MARGIN).min(460.0);
    let mut left = room.height() - MARGIN;
    let mut shown: Vec<(usize, &Notice, Arc<Galley>)> = Vec::new();
    for (place, notice) in facts.notices.iter().enumerate().rev() {
        // What has several lines points at letters of the line before.
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
        // What stays until it is dismissed stands out.
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
            overlay.commands.push(Command::Dismiss(place));
        }
        overlay.occupied.push(plate);
        top = plate.bottom() + 4.0;
    }
}

/// What the colours of a difference mean. Returns where it ends below.
fn legend(ui: &Ui, room: Rect) -> f32 {
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

/// Two pictures side by side, and the line between them, which can be dragged.
fn divider(ui: &mut Ui, rect: Rect, compass: Rect, settings: &mut Settings, overlay: &mut Overlay) {
    let whole = ui.ctx().viewport_rect();
    let share_at = |x: f32| (x - whole.left()) / whole.width().max(1.0);
    // A panel that opens over it pushes it aside, for it could not be grabbed there.
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
    overlay.occupied.push(grip);
    let painter = ui.painter();
    let line = |width, color| {
        painter
            .line_segment([pos2(x, rect.top()), pos2(x, rect.bottom())], Stroke::new(width, color));
    };
    line(4.0, SLATE);
    line(1.5, CHALK);
    // Beside the compass, or below what is written under it.
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

#[cfg(test)]
#[path = "hud_tests.rs"]
mod tests;
