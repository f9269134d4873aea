//! Colours and sizes that the parts of the overlay share.

use egui::Color32;

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
