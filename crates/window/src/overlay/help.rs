//! The page of keys and mouse.

use corniche_live::{KEY_HELP, MapCommand};
use egui::{Grid, Rect, RichText, ScrollArea, Ui, UiBuilder, vec2};

use super::palette::{CHALK, MARGIN, PanelActions, SLATE, framed};

/// The largest size of the page, in points.
const MOST: [f32; 2] = [470.0, 630.0];

/// Lays out the page of keys and mouse in the middle of the free space; a small window scrolls it.
pub(crate) fn help(ui: &mut Ui, room: Rect, answer: &mut PanelActions) {
    let room = room.shrink(MARGIN);
    let size = vec2(MOST[0].min(room.width()), MOST[1].min(room.height()));
    let plate = Rect::from_center_size(room.center(), size);
    framed(ui.painter(), plate, SLATE, CHALK.gamma_multiply(0.5));
    answer.occupied.push(plate);
    let inner = plate.shrink(10.0);
    let mut page = ui.new_child(UiBuilder::new().max_rect(inner));
    page.set_clip_rect(inner);
    page.horizontal(|ui| {
        ui.label(RichText::new("Mouse and keys").strong().color(CHALK));
        if ui.small_button("Close").clicked() {
            answer.commands.push(MapCommand::ToggleHelp);
        }
    });
    ScrollArea::both().auto_shrink([false, false]).show(&mut page, |ui| {
        Grid::new("help").num_columns(2).spacing(vec2(18.0, 4.0)).show(ui, |ui| {
            for (what, does) in KEY_HELP {
                ui.label(RichText::new(what).strong().color(CHALK));
                ui.label(RichText::new(does).color(CHALK));
                ui.end_row();
            }
        });
    });
}
