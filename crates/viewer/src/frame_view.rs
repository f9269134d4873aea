use crate::{camera::Camera, options::RoadOptions, style::Style};

/// What a picture shows and how, apart from the tiles.
#[derive(Debug, Clone, Copy)]
pub struct FrameView<'a> {
    /// The eye; its size is the picture's.
    pub camera: &'a Camera,
    /// Colours and widths.
    pub style: &'a Style,
    /// How roads are drawn.
    pub roads: RoadOptions,
    /// Factor on heights.
    pub exaggeration: f64,
    /// Length in the working CRS over true length: heights and widths are multiplied by it.
    pub point_scale: f64,
    /// True heights that the tint spans.
    pub height_range_m: [f64; 2],
    /// Whether the triangles of the ground show.
    pub wireframe: Wireframe,
}

/// Whether the edges of the ground's triangles are drawn, beneath the roads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "says it all")]
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
