use corniche_styles::Style;

use crate::{camera::Camera, options::RoadOptions};

/// What a picture shows and how, apart from the tiles.
#[derive(Debug, Clone, Copy)]
pub struct FrameView<'a> {
    /// The camera; its size is that of the picture.
    pub camera: &'a Camera,
    /// Colours and widths.
    pub style: &'a Style,
    /// How roads are drawn.
    pub roads: RoadOptions,
    /// Factor on heights.
    pub exaggeration: f64,
    /// Length in the working CRS divided by true length; heights and widths are multiplied by it.
    pub point_scale: f64,
    /// The true heights at the two ends of the height tint.
    pub height_range_m: [f64; 2],
    /// Whether the edges of the ground's triangles are drawn.
    pub wireframe: Wireframe,
}

/// Whether the edges of the ground's triangles are drawn, beneath the roads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say what they are")]
pub enum Wireframe {
    Hidden,
    Shown,
}

impl FrameView<'_> {
    /// World height of one metre of true height.
    #[must_use]
    pub fn vertical_scale(&self) -> f64 {
        self.exaggeration * self.point_scale
    }
}
