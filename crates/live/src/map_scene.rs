//! What a map shows: camera, style, roads and tiles, in one picture or in several.

use corniche_styles::Style;
use corniche_viewer::{FrameView, RoadOptions, Wireframe, camera::Camera, lod::Drawn};

/// What a map shows, in one picture or in several that differ in how roads are drawn. Two equal scenes look the same, as long as their
/// tiles are on the graphics card.
#[derive(Debug, Clone, PartialEq)]
pub struct MapScene {
    /// The camera; its size is that of the pictures.
    pub camera: Camera,
    /// Colours and widths.
    pub style: Style,
    /// How the roads of each picture are drawn: one picture, or GEO and SV.
    pub roads: Vec<RoadOptions>,
    /// Factor on heights.
    pub exaggeration: f64,
    /// Working metres to a true metre.
    pub point_scale: f64,
    /// All ground lies between these true heights.
    pub height_range_m: [f64; 2],
    /// How large a cell of a tile may look, pixels; may be infinite.
    pub cell_px: f64,
    /// Latitude of the middle of the package.
    pub latitude_deg: f64,
    /// Whether the edges of triangles are drawn.
    pub wireframe: Wireframe,
    /// The tiles to draw.
    pub drawn: Vec<Drawn>,
    /// Samples per pixel along each side.
    pub samples_per_side: u32,
}

impl MapScene {
    /// One of its pictures, with roads drawn like this.
    #[must_use]
    pub fn view(&self, roads: RoadOptions) -> FrameView<'_> {
        FrameView {
            camera: &self.camera,
            style: &self.style,
            roads,
            exaggeration: self.exaggeration,
            point_scale: self.point_scale,
            height_range_m: self.height_range_m,
            wall_m: FrameView::wall_beside_m(self.height_range_m),
            cell_px: self.cell_px,
            latitude_deg: self.latitude_deg,
            wireframe: self.wireframe,
        }
    }
}
