//! What the canvas draws of the map, and what came of drawing it.

use corniche_live::MapScene;

use crate::{map_pictures::Pictures, settings::Compare};

/// What the window shows of the map. Two equal scenes look the same, as long as their tiles are on the graphics card.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Scene {
    /// What the map shows.
    pub(crate) map: MapScene,
    /// Width and height of the window. The pictures are smaller while the map is drawn coarsely.
    pub(crate) window_px: [u32; 2],
    /// Whether one method is shown, or two are compared.
    pub(crate) compare: Compare,
    /// Grows with every change of lines that a person draws.
    pub(crate) lines_revision: u64,
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
        if self.map.camera.size_px() == self.window_px {
            wgpu::FilterMode::Nearest
        } else {
            wgpu::FilterMode::Linear
        }
    }
}
