use egui::{Color32, Ui};

use crate::{controls::Mode, formatting, window_content::WindowContent};

/// A narrower window leaves the milliseconds out of the status line, points.
const PASSES_WIDTH: f32 = 600.0;

/// Whether there is room for the panel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PanelRoom {
    /// There is, or the panel is closed.
    Enough,
    /// The window is too narrow.
    TooLittle,
}

/// The line at the lower edge of the window: positions, and what is going on.
pub(crate) fn status_line(ui: &mut Ui, content: &WindowContent<'_>, panel: PanelRoom) {
    // A small window leaves out the times of the passes, to have more room for the map. The panel shows them too.
    let has_room = ui.available_width() >= PASSES_WIDTH;
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 14.0;
        let small = |text: String| egui::RichText::new(text).size(12.0);
        // Lines are broken only between two items.
        let mut tell = |text: egui::RichText| ui.add(egui::Label::new(text).extend());
        match &content.cursor {
            Some(point) => {
                let [x, y, height_m] = point.at_m;
                tell(small(formatting::position(point.lon_lat_deg)));
                tell(small(formatting::coordinates(content.crs, [x, y])));
                tell(small(format!("ground {height_m:.1} m")));
            }
            None => {
                tell(small("no ground under the cursor".to_owned()));
            }
        }
        let orientation = content.pose.orientation;
        tell(small(format!("eye {}", formatting::length(content.pose.eye_m[2]))));
        tell(small(format!("heading {}", formatting::heading(orientation.heading_deg))));
        tell(small(format!("pitch {:.0}°", orientation.pitch_deg)));
        let passes = if has_room { content.passes } else { &[] };
        for (method, times) in passes {
            let [terrain_ms, roads_ms, composite_ms] =
                [times.terrain_ms, times.roads_ms, times.composite_ms];
            let method = formatting::method(*method);
            tell(small(format!(
                "{method}: terrain {terrain_ms:.1}, roads {roads_ms:.1}, composite {composite_ms:.1} ms"
            )));
        }
        if let Some(recording_s) = content.recording_s {
            let words = format!("recording for {recording_s:.0} s");
            tell(small(words).color(Color32::from_rgb(255, 140, 120)));
        }
        if content.mode == Mode::Fly {
            tell(small("fly mode: W A S D, Q E, Shift; F ends it".to_owned()).strong());
        }
        if content.is_full {
            tell(small(format!("{} tiles find no room", content.tiles_missing)));
        } else if content.tiles_missing > 0 {
            tell(small(format!("loading {} tiles", content.tiles_missing)));
        }
        if panel == PanelRoom::TooLittle {
            tell(small("a wider window shows the panel".to_owned()));
        }
    });
}
