//! What a picture shows and how: camera, style and options, without the tiles.

use corniche_styles::Style;

use crate::{camera::Camera, options::RoadOptions};

/// How large a cell may look unless `--cell-px` says otherwise, pixels.
const COARSEST_PX: f64 = 2.0;

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
    /// All ground lies between these true heights.
    pub height_range_m: [f64; 2],
    /// Height of the wall along the edge of the data, true metres; 0 for none. [`FrameView::wall_beside_m`] is what looks well.
    pub wall_m: f64,
    /// The size in pixels that a cell of a tile may have where the tiles were chosen; may be infinite. Levels of the relief are
    /// blended so that they meet without a step.
    pub cell_px: f64,
    /// Latitude of the middle of the package; colours of the ground may depend on it.
    pub latitude_deg: f64,
    /// Whether the edges of the ground's triangles are drawn, beneath the roads.
    pub is_wireframe: bool,
}

impl FrameView<'_> {
    /// Height of a wall along the edge of data with this range of heights: a part of it, so that the wall is seen beside
    /// mountains and does not hide gentle ground. Metres.
    #[must_use]
    pub fn wall_beside_m([lowest_m, highest_m]: [f64; 2]) -> f64 {
        0.15 * (highest_m - lowest_m).max(1.0)
    }

    /// How large a cell of the relief may look before finer ones are shown, pixels. Where tiles with larger cells are allowed, there
    /// may be a step in the shading where levels meet: without this bound, finer tiles would be shown as coarsely as these.
    pub(crate) fn blend_px(&self) -> f64 {
        self.cell_px.min(COARSEST_PX)
    }

    /// World height of one metre of true height.
    #[must_use]
    pub fn vertical_scale(&self) -> f64 {
        self.exaggeration * self.point_scale
    }
}
