//! What lies on the map itself: compass, scale bar, credits, notices, the divider of a split screen and the legend of a
//! difference.
//!
//! Everything is painted at a fixed place in the part of the map that the panel leaves free. It does not use windows of the
//! toolkit, so that nothing moves, fades or covers anything else.

mod answer;
mod compass;
mod credits;
mod divider;
mod legend;
mod notice_list;
mod palette;
mod scale_bar;

use egui::{Rect, Ui};

pub(crate) use self::answer::OverlayAnswer;
use self::{
    compass::{compass, compass_place},
    credits::{credits, credits_place},
    divider::divider,
    legend::legend,
    notice_list::notices,
    palette::LABEL_HEIGHT,
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
    let mut room = rect;
    room.max.y = scale_bar(ui, rect, credits_place(ui, rect, content).as_ref(), content);
    if room.width() > SMALL && room.height() > SMALL {
        let place = compass_place(rect);
        if settings.compare == Compare::Split {
            divider(ui, rect, place, settings, &mut answer);
            room.min.y += LABEL_HEIGHT;
        }
        room.max.x = compass(ui, place, content, &mut answer);
        if settings.compare == Compare::Difference {
            room.min.y = legend(ui, room);
        }
        notices(ui, room, content, &mut answer);
    }
    // The credits are painted last, so that nothing covers them.
    credits(ui, rect, content);
    answer
}
