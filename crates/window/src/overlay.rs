//! What lies on the map itself: compass, scale bar, credits, notices, the divider of a split screen, the legend of a
//! difference, the page of keys and the button for the panel.
//!
//! Everything is painted at a fixed place in the part of the map that the panel leaves free. It does not use windows of the
//! toolkit, so that nothing moves, fades or covers anything else.

mod answer;
mod compass;
mod credits;
mod divider;
mod handles;
mod help;
mod legend;
mod no_data;
mod notice_list;
mod palette;
mod panel_button;
mod scale_bar;

use egui::{Rect, Ui};

pub(crate) use self::answer::OverlayAnswer;
use self::{
    compass::{compass, compass_place},
    credits::{credits, credits_place},
    divider::divider,
    handles::handles,
    help::help,
    legend::legend,
    no_data::no_data,
    notice_list::notices,
    palette::LABEL_HEIGHT,
    panel_button::panel_button,
    scale_bar::scale_bar,
};
use crate::{
    settings::{Compare, Settings},
    window_content::WindowContent,
};

/// A map with a side of less than this shows only credits and scale bar, points.
const SMALL: f32 = 110.0;

/// Lays out everything on the map; `rect` is the part of the map that the panel leaves free.
pub(crate) fn overlay(
    ui: &mut Ui,
    rect: Rect,
    settings: &mut Settings,
    content: &WindowContent<'_>,
) -> OverlayAnswer {
    let mut answer = OverlayAnswer::default();
    // Nothing is painted over the panel or the status line, however small the window is.
    ui.set_clip_rect(rect);
    handles(ui, &content.drawing);
    let mut room = rect;
    room.max.y = scale_bar(ui, rect, credits_place(ui, rect, content).as_ref(), content);
    if settings.is_help_open {
        help(ui, room, &mut answer);
    } else if room.width() > SMALL && room.height() > SMALL {
        let place = compass_place(rect);
        if settings.compare == Compare::Split {
            divider(ui, rect, place, settings, &mut answer);
            room.min.y += LABEL_HEIGHT;
        }
        let [left, below] = compass(ui, place, content, &mut answer);
        if !settings.is_panel_open {
            panel_button(ui, room, below, &mut answer);
        }
        room.max.x = left;
        if settings.compare == Compare::Difference {
            room.min.y = legend(ui, room);
        }
        room.min.y = no_data(ui, room, content);
        notices(ui, room, content, &mut answer);
    }
    // The credits are painted last, so that nothing covers them.
    credits(ui, rect, content);
    answer
}
