//! The status line at the lower edge of the window. It omits items if there is little space.

use corniche_live::{Compare, MapSettings, controls::Mode, formatting};
use corniche_viewer::gpu::PassTimes;
use egui::{Color32, FontId, Label, RichText, Ui};

use crate::window_content::WindowContent;

/// The height of the line, points. It never changes, so that the map does not move.
pub(crate) const HEIGHT: f32 = 24.0;
/// The font size, points.
const LETTERS: f32 = 12.0;
/// The space between two items, points.
const GAP: f32 = 14.0;

/// An item of the status line.
struct StatusItem {
    text: String,
    color: Option<Color32>,
    /// The rank: if there is not enough space for all items, those with the highest rank are
    /// omitted.
    rank: u8,
}

impl StatusItem {
    fn new(rank: u8, text: impl Into<String>) -> Self {
        Self { text: text.into(), color: None, rank }
    }

    fn width(&self, ui: &Ui) -> f32 {
        let font = FontId::proportional(LETTERS);
        ui.painter().layout_no_wrap(self.text.clone(), font, Color32::WHITE).size().x + GAP
    }

    fn show(self, ui: &mut Ui) {
        let mut text = RichText::new(self.text).size(LETTERS);
        if let Some(color) = self.color {
            text = text.color(color);
        }
        ui.add(Label::new(text).extend());
    }
}

/// Lays out the status line: positions on the left, activities on the right. It has one row; items
/// that do not fit are omitted, the least important first. `is_narrow` means that an open panel did
/// not fit.
pub(crate) fn status_line(
    ui: &mut Ui,
    settings: &MapSettings,
    content: &WindowContent<'_>,
    is_narrow: bool,
) {
    let room = ui.available_width();
    let mut items: Vec<StatusItem> = happening(content, is_narrow);
    let count = items.len();
    items.extend(positions(settings, content));
    let mut places: Vec<usize> = (0..items.len()).collect();
    places.sort_by_key(|place| items[*place].rank);
    let mut taken = 0.0;
    let mut is_shown = vec![false; items.len()];
    for place in places {
        let width = items[place].width(ui);
        if taken + width <= room {
            taken += width;
            is_shown[place] = true;
        }
    }
    let mut shown =
        items.into_iter().zip(is_shown).enumerate().filter(|(_, (_, is_shown))| *is_shown);
    let (right, left): (Vec<_>, Vec<_>) = shown.by_ref().partition(|(place, _)| *place < count);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        for (_, (item, _)) in left {
            item.show(ui);
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            for (_, (item, _)) in right {
                item.show(ui);
            }
        });
    });
}

/// The current activities, the most important first.
fn happening(content: &WindowContent<'_>, is_narrow: bool) -> Vec<StatusItem> {
    let mut items = Vec::new();
    if is_narrow {
        items.push(StatusItem::new(0, "a wider window shows the panel"));
    }
    if let Some(recording_s) = content.recording_s {
        let color = Some(Color32::from_rgb(255, 140, 120));
        items.push(StatusItem {
            color,
            ..StatusItem::new(0, format!("recording for {recording_s:.0} s"))
        });
    }
    if content.mode == Mode::Fly {
        let color = Some(Color32::WHITE);
        items.push(StatusItem {
            color,
            ..StatusItem::new(1, "fly mode: W A S D, Q E, Shift; F ends it")
        });
    }
    if content.is_full {
        items.push(StatusItem::new(
            2,
            format!("{} tiles exceed the GPU memory", content.tiles_missing),
        ));
    } else if content.tiles_missing > 0 {
        items.push(StatusItem::new(2, format!("loading {} tiles", content.tiles_missing)));
    }
    items
}

/// The ground under the cursor, the camera, the drawing method of roads and the time it takes.
fn positions(settings: &MapSettings, content: &WindowContent<'_>) -> Vec<StatusItem> {
    let mut items = Vec::new();
    let mut say = |rank, text: String| items.push(StatusItem::new(rank, text));
    match &content.cursor {
        Some(point) => {
            let [x, y, height_m] = point.at_m;
            say(1, formatting::position(point.lon_lat_deg));
            say(7, formatting::coordinates(content.crs, [x, y]));
            say(3, format!("ground {height_m:.1} m"));
        }
        None => say(1, "no ground under the cursor".to_owned()),
    }
    let orientation = content.pose.orientation;
    say(4, format!("eye {}", formatting::length(content.pose.eye_m[2])));
    say(5, format!("heading {}", formatting::heading(orientation.heading_deg)));
    say(6, format!("pitch {:.0}°", orientation.pitch_deg));
    let roads = match settings.compare {
        Compare::Off => format!("roads {}", formatting::method(settings.roads.method)),
        Compare::Split | Compare::Difference => "roads GEO and SV".to_owned(),
    };
    let by = if content.is_software { ", drawn by the processor" } else { "" };
    say(3, format!("{roads}{by}"));
    for (method, times) in content.passes {
        let PassTimes { terrain_ms, areas_ms, roads_ms, decks_ms, composite_ms } = *times;
        let areas = if areas_ms > 0.0 { format!(" areas {areas_ms:.1},") } else { String::new() };
        let bridges =
            if decks_ms > 0.0 { format!(" bridges {decks_ms:.1},") } else { String::new() };
        let method = formatting::method(*method);
        say(
            8,
            format!(
                "{method}: terrain {terrain_ms:.1},{areas} roads {roads_ms:.1},{bridges} composite {composite_ms:.1} ms"
            ),
        );
    }
    items
}
