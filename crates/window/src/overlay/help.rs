//! The page of keys and mouse.

use corniche_live::Command;
use egui::{Grid, Rect, RichText, ScrollArea, Ui, UiBuilder, vec2};

use super::palette::{CHALK, MARGIN, OverlayAnswer, SLATE, framed};

/// The page is no larger than this, points.
const MOST: [f32; 2] = [470.0, 630.0];

/// What to do with mouse and keys, and what it does.
const ROWS: [(&str, &str); 24] = [
    ("left drag", "move the map; in fly mode look around"),
    ("right drag, Ctrl + left drag", "turn and tilt around the middle"),
    ("middle drag", "turn and tilt around the cursor"),
    ("wheel", "zoom at the cursor; in fly mode speed"),
    ("double click", "zoom in; with Shift out"),
    ("arrows", "move; with Shift turn and tilt"),
    ("+  −", "zoom by a level; with Shift by two"),
    ("R, Home", "back to the first view"),
    ("N", "north up"),
    ("F", "fly mode, and back"),
    ("T", "straight from above, and back"),
    ("W A S D, Q E", "in fly mode: fly, sink, rise"),
    ("Shift", "in fly mode: faster"),
    ("V", "copy this view as a command"),
    ("P, Shift P", "picture of the map, of the window"),
    ("C", "record the camera's way, and stop"),
    ("L, then click, Shift click", "draw lines: a point at the end, inside"),
    ("Enter, Del, Shift Del", "end the line, remove the point, the line"),
    ("G, M", "line or area, round its corners"),
    ("Ctrl Z, Ctrl Y, Ctrl S", "take back, make again, save"),
    ("Tab", "show and hide the panel"),
    ("?", "show and hide this page"),
    ("Esc", "close this page; end the line"),
    ("Ctrl Q", "close the window"),
];

/// Lays out the page of keys and mouse in the middle of the room; a small window scrolls it.
pub(crate) fn help(ui: &mut Ui, room: Rect, answer: &mut OverlayAnswer) {
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
            answer.commands.push(Command::ToggleHelp);
        }
    });
    ScrollArea::both().auto_shrink([false, false]).show(&mut page, |ui| {
        Grid::new("help").num_columns(2).spacing(vec2(18.0, 4.0)).show(ui, |ui| {
            for (what, does) in ROWS {
                ui.label(RichText::new(what).strong().color(CHALK));
                ui.label(RichText::new(does).color(CHALK));
                ui.end_row();
            }
        });
    });
}
