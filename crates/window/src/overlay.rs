//! The overlay on the map: compass, scale bar, attribution, notices, the divider of a split screen,
//! the legend of a difference, the page of keys and the button for the panel.
//!
//! Everything is painted at a fixed position in the part of the map that the panel leaves free. The
//! overlay does not use windows of the toolkit, so that nothing moves, fades or covers anything
//! else.

mod compass;
mod divider;
mod help;
mod notice_list;
mod palette;
mod scale_bar;

use corniche_live::{Compare, MapSettings};
use egui::{Rect, Ui};

pub(crate) use self::palette::{PanelActions, color32};
use self::{
    compass::{compass, compass_place, panel_button},
    divider::{divider, handles},
    help::help,
    notice_list::{legend, no_data, notices},
    palette::LABEL_HEIGHT,
    scale_bar::{credits, credits_place, scale_bar},
};
use crate::window_content::WindowContent;

/// A map with a side below this number of points shows only attribution and scale bar.
const SMALL: f32 = 110.0;

/// Lays out everything on the map; `rect` is the part of the map that the panel leaves free.
pub(crate) fn overlay(
    ui: &mut Ui,
    rect: Rect,
    settings: &mut MapSettings,
    content: &WindowContent<'_>,
    answer: &mut PanelActions,
) {
    // Nothing is painted over the panel or the status line, however small the window is.
    ui.set_clip_rect(rect);
    handles(ui, &content.drawing);
    let mut room = rect;
    room.max.y = scale_bar(ui, rect, credits_place(ui, rect, content).as_ref(), content);
    if settings.is_help_open {
        help(ui, room, answer);
    } else if room.width() > SMALL && room.height() > SMALL {
        let place = compass_place(rect);
        if settings.compare == Compare::Split {
            divider(ui, rect, place, settings, answer);
            room.min.y += LABEL_HEIGHT;
        }
        let [left, below] = compass(ui, place, content, answer);
        if !settings.is_panel_open {
            panel_button(ui, room, below, answer);
        }
        room.max.x = left;
        if settings.compare == Compare::Difference {
            room.min.y = legend(ui, room);
        }
        room.min.y = no_data(ui, room, content);
        notices(ui, room, content, answer);
    }
    // The attribution is painted last, so that nothing covers it.
    credits(ui, rect, content);
}
