//! GPU buffers of the points of a tile.

use std::ops::Range;

use wgpu::{
    Buffer, BufferUsages, RenderPass, VertexBufferLayout, VertexStepMode, vertex_attr_array,
};

use super::{Gpu, pipeline::vertex_layout};
use crate::{layer_class::LayerClass, tiles::PointMarks};

/// Vertex layout with one instance per point.
pub(crate) const POINTS: VertexBufferLayout<'static> =
    vertex_layout::<[f32; 3]>(VertexStepMode::Instance, &vertex_attr_array![0 => Float32x3]);

/// The points of a tile on the GPU.
pub(crate) struct PointBuffers {
    instances: Buffer,
    pub(crate) classes: Vec<(LayerClass, Range<u32>)>,
}

impl PointBuffers {
    /// Uploads the points of a tile; `None` if it has none.
    pub(crate) fn new(gpu: &Gpu, points: &PointMarks) -> Option<Self> {
        let bytes: &[u8] = bytemuck::cast_slice(&points.places_in_tile);
        (!bytes.is_empty()).then(|| Self {
            instances: gpu.buffer("points", bytes, BufferUsages::VERTEX),
            classes: points.classes.clone(),
        })
    }

    /// Size of the buffer that [`PointBuffers::new`] creates, bytes.
    pub(crate) fn bytes_of(points: &PointMarks) -> u64 {
        size_of_val(&points.places_in_tile[..]) as u64
    }

    /// Size of the buffer, bytes.
    pub(crate) fn gpu_bytes(&self) -> u64 {
        self.instances.size()
    }

    /// Draws a quad for each point of a class. The caller sets pipeline and bind groups.
    pub(crate) fn draw(&self, pass: &mut RenderPass<'_>, class: LayerClass) {
        if let Some((_, range)) = self.classes.iter().find(|of| of.0 == class) {
            pass.set_vertex_buffer(0, self.instances.slice(..));
            pass.draw(0..4, range.clone());
        }
    }
}
