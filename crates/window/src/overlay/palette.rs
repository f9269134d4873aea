//! What the parts of the overlay share: colours, sizes, plates, and what a person clicked on them.

use corniche_live::Command;
use egui::{Color32, CornerRadius, Painter, Rect, Response, Sense, Stroke, StrokeKind, Ui};

/// Distance of the parts from the edges and from each other, points.
pub(crate) const MARGIN: f32 = 8.0;
/// Height of a row of labels at the upper edge, points.
pub(crate) const LABEL_HEIGHT: f32 = 30.0;
/// A scale bar is no longer than this, points.
pub(crate) const LONGEST_BAR: f32 = 160.0;
/// Credits and scale bar are dark on light, readable over any style of map: this is the light.
pub(crate) const PAPER: Color32 = Color32::from_rgba_premultiplied(214, 214, 214, 214);
/// And this is the dark.
pub(crate) const INK: Color32 = Color32::from_rgb(24, 28, 32);
/// The edge of a warning.
pub(crate) const AMBER: Color32 = Color32::from_rgb(214, 160, 60);
/// All else is light on dark: this is the dark.
pub(crate) const SLATE: Color32 = Color32::from_rgba_premultiplied(22, 24, 28, 225);
/// And this is the light.
pub(crate) const CHALK: Color32 = Color32::from_rgb(236, 238, 240);

/// What a person did in the panel and on the overlay in a frame.
#[derive(Default)]
pub(crate) struct Answer {
    /// What the person asked for.
    pub(crate) commands: Vec<Command>,
    /// The parts of the window where the mouse does not act on the map.
    pub(crate) occupied: Vec<Rect>,
}

impl Answer {
    /// A place on the map that asks for something when it is clicked.
    pub(crate) fn clickable(
        &mut self,
        ui: &Ui,
        (place, name): (Rect, &str),
        hover: &str,
        command: Command,
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
