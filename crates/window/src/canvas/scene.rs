use corniche_styles::Style;
use corniche_viewer::{RoadOptions, Wireframe, camera::Camera, lod::Drawn};

use crate::{map_pictures::Pictures, settings::Compare};

/// What the map shows. Two equal scenes look the same, as long as their tiles are on the graphics card.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Scene {
    /// The camera; its size is that of the pictures.
    pub(crate) camera: Camera,
    /// Width and height of the window. The pictures are smaller while the map is drawn coarsely.
    pub(crate) window_px: [u32; 2],
    /// Colours and widths.
    pub(crate) style: Style,
    /// How the roads of each picture are drawn: one picture, or GEO and SV.
    pub(crate) roads: Vec<RoadOptions>,
    /// Whether one method is shown, or two are compared.
    pub(crate) compare: Compare,
    /// Factor on heights.
    pub(crate) exaggeration: f64,
    /// Working metres to a true metre.
    pub(crate) point_scale: f64,
    /// All ground lies between these true heights.
    pub(crate) height_range_m: [f64; 2],
    /// How large a cell of a tile may look, pixels; may be infinite.
    pub(crate) cell_px: f64,
    /// Latitude of the middle of the package.
    pub(crate) latitude_deg: f64,
    /// Whether the edges of triangles are drawn.
    pub(crate) wireframe: Wireframe,
    /// The tiles to draw.
    pub(crate) drawn: Vec<Drawn>,
    /// Grows with every change of lines that a person draws.
    pub(crate) lines_revision: u64,
    /// Samples per pixel along each side.
    pub(crate) samples_per_side: u32,
}

/// What came of drawing a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Drew {
    /// The pictures.
    pub(crate) pictures: Pictures,
    /// Whether anything was drawn: not if the scene was the same as before.
    pub(crate) is_new: bool,
}

/// Numbers of the scene that was drawn last, all pictures together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Counts {
    /// Triangles of the ground, skirts not counted.
    pub(crate) triangles: u64,
    /// Segments of roads.
    pub(crate) segments: u64,
}

impl Scene {
    /// How the pictures are brought into the window: pixel for pixel, or enlarged where they are smaller.
    pub(crate) fn filter(&self) -> wgpu::FilterMode {
        if self.camera.size_px() == self.window_px {
            wgpu::FilterMode::Nearest
        } else {
            wgpu::FilterMode::Linear
        }
    }
}
