//! The line at the lower edge of the window, whose items give way when there is little room.

use corniche_live::{Compare, MapSettings, controls::Mode, formatting};
use corniche_viewer::gpu::PassTimes;
use egui::{Color32, FontId, Label, RichText, Ui};

use crate::window_content::WindowContent;

/// Height of the line, points. It never changes, so that the map keeps its place.
pub(crate) const HEIGHT: f32 = 24.0;
/// Size of its letters, points.
const LETTERS: f32 = 12.0;
/// Room between two items, points.
const GAP: f32 = 14.0;

/// A part of the line.
struct Item {
    text: String,
    color: Option<Color32>,
    /// Where there is not room for all items, those with the highest rank are left out.
    rank: u8,
}

impl Item {
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

/// The line at the lower edge of the window: positions on the left, what is going on at the right. It has one row; what finds
/// no room is left out, the least important first. `is_narrow` says that an open panel found no room.
pub(crate) fn status_line(
    ui: &mut Ui,
    settings: &MapSettings,
    content: &WindowContent<'_>,
    is_narrow: bool,
) {
    let room = ui.available_width();
    let mut items: Vec<Item> = happening(content, is_narrow);
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

/// What is going on, the most important first.
fn happening(content: &WindowContent<'_>, is_narrow: bool) -> Vec<Item> {
    let mut items = Vec::new();
    if is_narrow {
        items.push(Item::new(0, "a wider window shows the panel"));
    }
    if let Some(recording_s) = content.recording_s {
        let color = Some(Color32::from_rgb(255, 140, 120));
        items.push(Item { color, ..Item::new(0, format!("recording for {recording_s:.0} s")) });
    }
    if content.mode == Mode::Fly {
        let color = Some(Color32::WHITE);
        items.push(Item { color, ..Item::new(1, "fly mode: W A S D, Q E, Shift; F ends it") });
    }
    if content.is_full {
        items.push(Item::new(2, format!("{} tiles find no room", content.tiles_missing)));
    } else if content.tiles_missing > 0 {
        items.push(Item::new(2, format!("loading {} tiles", content.tiles_missing)));
    }
    items
}

/// The ground under the cursor, the camera, how roads are drawn and how long it takes.
fn positions(settings: &MapSettings, content: &WindowContent<'_>) -> Vec<Item> {
    let mut items = Vec::new();
    match &content.cursor {
        Some(point) => {
            let [x, y, height_m] = point.at_m;
            items.push(Item::new(1, formatting::position(point.lon_lat_deg)));
            items.push(Item::new(7, formatting::coordinates(content.crs, [x, y])));
            items.push(Item::new(3, format!("ground {height_m:.1} m")));
        }
        None => items.push(Item::new(1, "no ground under the cursor")),
    }
    let orientation = content.pose.orientation;
    items.push(Item::new(4, format!("eye {}", formatting::length(content.pose.eye_m[2]))));
    items.push(Item::new(5, format!("heading {}", formatting::heading(orientation.heading_deg))));
    items.push(Item::new(6, format!("pitch {:.0}°", orientation.pitch_deg)));
    let roads = match settings.compare {
        Compare::Off => format!("roads {}", formatting::method(settings.roads.method)),
        Compare::Split | Compare::Difference => "roads GEO and SV".to_owned(),
    };
    let by = if content.is_software { ", drawn by the processor" } else { "" };
    items.push(Item::new(3, format!("{roads}{by}")));
    for (method, times) in content.passes {
        let PassTimes { terrain_ms, areas_ms, roads_ms, decks_ms, composite_ms } = *times;
        let areas =
            if content.has_areas { format!(" areas {areas_ms:.1},") } else { String::new() };
        let bridges =
            if decks_ms > 0.0 { format!(" bridges {decks_ms:.1},") } else { String::new() };
        let method = formatting::method(*method);
        items.push(Item::new(
            8,
            format!(
                "{method}: terrain {terrain_ms:.1},{areas} roads {roads_ms:.1},{bridges} composite {composite_ms:.1} ms"
            ),
        ));
    }
    items
}
