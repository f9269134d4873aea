//! The panel at the window's right side, and the layout of panel and map.

mod actions;
mod look;
mod performance;
mod status_line;

use corniche_live::{MapCommand, MapSettings};
use egui::{Color32, Rect, TextureId, Ui, pos2};

use self::status_line::status_line;
pub(crate) use crate::overlay::PanelActions;
use crate::{overlay, window_content::WindowContent};

/// Width of the panel, points.
const WIDTH: f32 = 300.0;
/// A window with less space than this next to the panel shows the map without the panel.
const LEAST_MAP_WIDTH: f32 = 140.0;
/// A window narrower than this opens with the panel hidden.
const LEAST_WIDTH_WITH_PANEL: f32 = 600.0;

/// Sets up the toolkit: dark colours, and no animations, so that nothing is redrawn without a
/// reason.
pub(crate) fn set_up(ui: &egui::Context) {
    ui.set_theme(egui::Theme::Dark);
    ui.all_styles_mut(|style| {
        style.animation_time = 0.0;
        // The toolkit's own grey is hard to read on a bright day.
        style.visuals.widgets.noninteractive.fg_stroke.color = Color32::from_gray(205);
        style.visuals.widgets.inactive.fg_stroke.color = Color32::from_gray(220);
        style.interaction.selectable_labels = false;
        style.text_styles.insert(egui::TextStyle::Small, egui::FontId::proportional(11.0));
    });
}

/// The width of the open panel in a window of this width, both in points: 0 if there is no space
/// for it.
pub(crate) fn width(window_width: f32) -> f32 {
    if window_width >= WIDTH + LEAST_MAP_WIDTH { WIDTH } else { 0.0 }
}

/// The initial width of the panel in a window of this width, both in points: 0 in a narrow window,
/// where the map has all the space until the user opens the panel.
pub(crate) fn first_width(window_width: f32) -> f32 {
    if window_width >= LEAST_WIDTH_WITH_PANEL { WIDTH } else { 0.0 }
}

/// Lays out the whole window: the map, the panel, the status line and the overlay.
pub(crate) fn show(
    ui: &mut Ui,
    settings: &mut MapSettings,
    content: &WindowContent<'_>,
    pictures: &[TextureId],
) -> PanelActions {
    let mut answer = PanelActions::default();
    let whole = ui.ctx().viewport_rect();
    paint(ui, whole, settings.divider_share, pictures);
    let has_room = width(whole.width()) > 0.0;
    let finds_none = settings.is_panel_open && !has_room;
    let status = egui::Panel::bottom("status")
        .resizable(false)
        .show_separator_line(false)
        .exact_size(status_line::HEIGHT)
        .frame(frame(ui).inner_margin(egui::Margin::symmetric(8, 3)))
        .show(ui, |ui| status_line(ui, settings, content, finds_none));
    answer.occupied.push(status.response.rect);
    if settings.is_panel_open && has_room {
        let panel = egui::Panel::right("panel")
            .resizable(false)
            .exact_size(WIDTH)
            .frame(frame(ui).inner_margin(egui::Margin::same(8)))
            .show(ui, |ui| sections(ui, settings, content, &mut answer.commands));
        answer.occupied.push(panel.response.rect);
    }
    let free = ui.available_rect_before_wrap();
    overlay::overlay(ui, free, settings, content, &mut answer);
    answer
}

fn frame(ui: &Ui) -> egui::Frame {
    egui::Frame::new().fill(ui.visuals().panel_fill.gamma_multiply(0.96))
}

fn sections(
    ui: &mut Ui,
    settings: &mut MapSettings,
    content: &WindowContent<'_>,
    commands: &mut Vec<MapCommand>,
) {
    ui.horizontal(|ui| {
        ui.heading("Corniche");
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            for (words, command) in
                [("Hide (Tab)", MapCommand::TogglePanel), ("Help (?)", MapCommand::ToggleHelp)]
            {
                if ui.small_button(words).clicked() {
                    commands.push(command);
                }
            }
        });
    });
    egui::ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
        section(ui, "Roads", |ui| look::roads(ui, settings));
        section(ui, "Classes", |ui| look::classes(ui, settings, content));
        section(ui, "Map", |ui| look::map(ui, settings, content));
        section(ui, "Camera", |ui| actions::camera(ui, settings, content, commands));
        section(ui, "Lines", |ui| actions::lines(ui, content, commands));
        section(ui, "Record", |ui| actions::record(ui, content, commands));
        section(ui, "Advanced", |ui| look::advanced(ui, settings, content));
        section(ui, "Performance", |ui| performance::show(ui, content));
    });
}

/// Sections for advanced users, which are folded at first.
const FOLDED: [&str; 2] = ["Advanced", "Performance"];

fn section(ui: &mut Ui, title: &str, add: impl FnOnce(&mut Ui)) {
    egui::CollapsingHeader::new(egui::RichText::new(title).strong())
        .default_open(!FOLDED.contains(&title))
        .show_unindented(ui, add);
}

/// Paints the map. It fills the whole window, even behind the panel, so that it does not move when
/// the panel opens.
fn paint(ui: &Ui, whole: Rect, divider_share: f32, pictures: &[TextureId]) {
    let painter = ui.painter();
    let image = |texture, from: f32, to: f32| {
        let part = Rect::from_min_max(
            pos2(whole.left() + from * whole.width(), whole.top()),
            pos2(whole.left() + to * whole.width(), whole.bottom()),
        );
        let uv = Rect::from_min_max(pos2(from, 0.0), pos2(to, 1.0));
        painter.image(texture, part, uv, Color32::WHITE);
    };
    match pictures {
        [left, right] => {
            image(*left, 0.0, divider_share);
            image(*right, divider_share, 1.0);
        }
        all => all.iter().for_each(|texture| image(*texture, 0.0, 1.0)),
    }
}

#[cfg(test)]
#[path = "panel_tests.rs"]
mod tests;
