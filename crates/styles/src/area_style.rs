//! The style of a class of areas: a colour and an opacity.

use crate::Rgb;

/// How the areas of one class are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AreaStyle {
    /// Colour.
    pub color: Rgb,
    /// How much of the ground an area hides: 1 hides it completely, 0 does not draw the class.
    pub opacity: f32,
    /// Ground steeper than this is not painted, degrees. From 0.7 times its tangent on, the paint
    /// fades. `None`: all ground is painted.
    pub steepest_deg: Option<f32>,
}

impl AreaStyle {
    /// From this share of the tangent of [`AreaStyle::steepest_deg`] on, the ground shows through.
    pub const STEEP_SHARE: f64 = 0.7;
}
