//! The contents and the look of a picture: camera, style and options, without the tiles.

use corniche_styles::Style;

use crate::{camera::Camera, layers::PackageLooks, options::RoadOptions};

/// Maximum size of a cell on the picture, pixels, unless `--cell-px` sets another.
const COARSEST_PX: f64 = 2.0;

/// The contents and the look of a picture, apart from the tiles.
#[derive(Debug, Clone, Copy)]
pub struct FrameView<'a> {
    /// Camera; its size is the size of the picture.
    pub camera: &'a Camera,
    /// Colours and widths.
    pub style: &'a Style,
    /// How the package's layers are drawn.
    pub layers: &'a PackageLooks,
    /// How roads are drawn.
    pub roads: RoadOptions,
    /// Factor on heights.
    pub exaggeration: f64,
    /// Length in the working CRS divided by true length; heights and widths are multiplied by it.
    pub point_scale: f64,
    /// All ground is between these true heights.
    pub height_range_m: [f64; 2],
    /// Height of the wall along the edge of the data, true metres; 0 for no wall.
    /// [`FrameView::wall_beside_m`] returns a suitable height.
    pub wall_m: f64,
    /// The maximum size in pixels of a cell, with which the tiles were chosen; may be infinite.
    /// Levels of the relief are blended so that they meet without a step.
    pub cell_px: f64,
    /// Latitude of the middle of the package; colours of the ground may depend on it.
    pub latitude_deg: f64,
    /// Whether the edges of the ground's triangles are drawn, below the roads.
    pub is_wireframe: bool,
}

impl FrameView<'_> {
    /// Height of a wall along the edge of data with this range of heights, metres. It is a share of
    /// the range, so that the wall is visible next to mountains and does not hide gentle ground.
    #[must_use]
    pub fn wall_beside_m([lowest_m, highest_m]: [f64; 2]) -> f64 {
        0.15 * (highest_m - lowest_m).max(1.0)
    }

    /// Maximum size of a cell of the relief before finer cells are shown, pixels. If larger cells
    /// are allowed, there may be a step in the shading where levels meet: without this bound, finer
    /// tiles would be shown as coarsely as these.
    pub(crate) fn blend_px(&self) -> f64 {
        self.cell_px.min(COARSEST_PX)
    }

    /// World height of one metre of true height.
    #[must_use]
    pub fn vertical_scale(&self) -> f64 {
        self.exaggeration * self.point_scale
    }
}
