//! Shared parts of the overlay: colours, sizes, plates, and the user's clicks.

use corniche_live::MapCommand;
use corniche_styles::Rgb;
use egui::{Color32, CornerRadius, Painter, Rect, Response, Sense, Stroke, StrokeKind, Ui};

/// Distance of the parts from the edges and from each other, points.
pub(crate) const MARGIN: f32 = 8.0;
/// Height of a row of labels at the upper edge, points.
pub(crate) const LABEL_HEIGHT: f32 = 30.0;
/// The largest length of a scale bar, in points.
pub(crate) const LONGEST_BAR: f32 = 160.0;
/// The light background of attribution and scale bar, whose dark text is readable over any style of
/// map.
pub(crate) const PAPER: Color32 = Color32::from_rgba_premultiplied(214, 214, 214, 214);
/// The dark text of attribution and scale bar.
pub(crate) const INK: Color32 = Color32::from_rgb(24, 28, 32);
/// The edge of a warning.
pub(crate) const AMBER: Color32 = Color32::from_rgb(214, 160, 60);
/// The dark background of all other parts.
pub(crate) const SLATE: Color32 = Color32::from_rgba_premultiplied(22, 24, 28, 225);
/// The light text of all other parts.
pub(crate) const CHALK: Color32 = Color32::from_rgb(236, 238, 240);

/// The user's actions in the panel and on the overlay in a frame.
#[derive(Default)]
pub(crate) struct PanelActions {
    /// The commands of the user.
    pub(crate) commands: Vec<MapCommand>,
    /// The parts of the window where the mouse does not act on the map.
    pub(crate) occupied: Vec<Rect>,
}

impl PanelActions {
    /// A clickable area on the map, with its command.
    pub(crate) fn clickable(
        &mut self,
        ui: &Ui,
        (place, name): (Rect, &str),
        hover: &str,
        command: MapCommand,
    ) -> Response {
        let response =
            ui.interact(place, ui.scope_id().with(name), Sense::click()).on_hover_text(hover);
        if response.clicked() {
            self.commands.push(command);
        }
        self.occupied.push(place);
        response
    }
}

/// A plate with an edge.
pub(crate) fn framed(painter: &Painter, plate: Rect, fill: Color32, edge: Color32) {
    let stroke = Stroke::new(1.0, edge);
    painter.rect(plate, CornerRadius::same(4), fill, stroke, StrokeKind::Inside);
}

/// Converts a colour of a style to the toolkit's type.
pub(crate) fn color32(color: Rgb) -> Color32 {
    let [red, green, blue] = color.map(|part| (part * 255.0).round() as u8);
    Color32::from_rgb(red, green, blue)
}
