//! The style of a class of points: a mark of a size in pixels.

use crate::Rgb;

/// How the points of one class are drawn: as discs, over lines and roads, where the ground does not
/// hide them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointStyle {
    /// Colour.
    pub color: Rgb,
    /// Diameter of the disc on the picture, pixels.
    pub size_px: f32,
    /// Colour of an edge of one pixel, outside of the disc; `None`: no edge.
    pub outline: Option<Rgb>,
    /// How much of the map a mark hides: 1 hides it completely, 0 does not draw the class.
    pub opacity: f32,
    /// The most true metres of ground per pixel at which points are fully drawn, as in
    /// [`RoadStyle::max_pixel_m`](crate::RoadStyle::max_pixel_m).
    pub max_pixel_m: Option<f32>,
}
