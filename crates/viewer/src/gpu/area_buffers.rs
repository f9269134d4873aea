//! GPU buffers of the areas of a tile.

use wgpu::{
    Buffer, BufferUsages, IndexFormat, RenderPass, VertexBufferLayout, VertexStepMode,
    vertex_attr_array,
};

use super::{Gpu, pipeline::vertex_layout};
use crate::{
    layer_class::LayerClass,
    tiles::{AreaCorner, AreaVolumes, AreaWall, ClassVolumes},
};

/// Vertex layout with one instance per wall: two plan positions, bottom and top.
pub(crate) const WALLS: VertexBufferLayout<'static> = vertex_layout::<AreaWall>(
    VertexStepMode::Instance,
    &vertex_attr_array![0 => Float32x2, 1 => Float32x2, 2 => Float32x2],
);
/// Vertex layout with one vertex per corner of the caps: a plan position, bottom and top.
pub(crate) const CORNERS: VertexBufferLayout<'static> = vertex_layout::<AreaCorner>(
    VertexStepMode::Vertex,
    &vertex_attr_array![0 => Float32x2, 1 => Float32x2],
);
/// Vertex layout with one instance for the box around each class: two positions.
pub(crate) const BOXES: VertexBufferLayout<'static> = vertex_layout::<[[f32; 3]; 2]>(
    VertexStepMode::Instance,
    &vertex_attr_array![0 => Float32x3, 1 => Float32x3],
);

/// Corners of the triangle strips of a wall and of a box, in the order of `shaders/areas.wgsl`.
const WALL_CORNERS: u32 = 4;
const BOX_CORNERS: u32 = 14;

/// The areas of a tile on the GPU.
pub(crate) struct AreaBuffers {
    walls: Buffer,
    corners: Buffer,
    triangles: Buffer,
    boxes: Buffer,
    pub(crate) classes: Vec<ClassVolumes>,
    /// Box around all areas, as in [`AreaVolumes`].
    pub(crate) box_in_tile: [[f32; 3]; 2],
}

impl AreaBuffers {
    /// Uploads the areas of a tile; `None` if it has none.
    pub(crate) fn new(gpu: &Gpu, areas: &AreaVolumes) -> Option<Self> {
        let box_in_tile = areas.box_in_tile?;
        let boxes: Vec<_> = areas.classes.iter().map(|of| of.box_in_tile).collect();
        let vertices = |name, bytes: &[u8]| gpu.buffer(name, bytes, BufferUsages::VERTEX);
        Some(Self {
            walls: vertices("area walls", bytemuck::cast_slice(&areas.walls)),
            corners: vertices("area corners", bytemuck::cast_slice(&areas.corners)),
            triangles: gpu.buffer(
                "area triangles",
                bytemuck::cast_slice(&areas.triangles),
                BufferUsages::INDEX,
            ),
            boxes: vertices("area boxes", bytemuck::cast_slice(&boxes)),
            classes: areas.classes.clone(),
            box_in_tile,
        })
    }

    /// Size of the buffers that [`AreaBuffers::new`] creates, bytes.
    pub(crate) fn bytes_of(areas: &AreaVolumes) -> u64 {
        let lists = size_of_val(&areas.walls[..])
            + size_of_val(&areas.corners[..])
            + size_of_val(&areas.triangles[..]);
        lists as u64 + areas.classes.len() as u64 * BOXES.array_stride
    }

    /// Size of the buffers, bytes.
    pub(crate) fn gpu_bytes(&self) -> u64 {
        [&self.walls, &self.corners, &self.triangles, &self.boxes]
            .into_iter()
            .map(Buffer::size)
            .sum()
    }

    /// The areas of a class.
    pub(crate) fn of_class(&self, class: LayerClass) -> Option<&ClassVolumes> {
        self.classes.iter().find(|volumes| volumes.class == class)
    }

    /// Draws the walls of a class. The caller sets pipeline and bind groups.
    pub(crate) fn draw_walls(&self, pass: &mut RenderPass<'_>, volumes: &ClassVolumes) {
        pass.set_vertex_buffer(0, self.walls.slice(..));
        pass.draw(0..WALL_CORNERS, volumes.walls.clone());
    }

    /// Draws the upper or the lower caps of a class, depending on the pipeline. The caller sets
    /// pipeline and bind groups.
    pub(crate) fn draw_caps(&self, pass: &mut RenderPass<'_>, volumes: &ClassVolumes) {
        pass.set_vertex_buffer(0, self.corners.slice(..));
        pass.set_index_buffer(self.triangles.slice(..), IndexFormat::Uint32);
        pass.draw_indexed(volumes.triangles.clone(), 0, 0..1);
    }

    /// Draws the box around a class. The caller sets pipeline and bind groups.
    pub(crate) fn draw_box(&self, pass: &mut RenderPass<'_>, class: LayerClass) {
        let place = self.classes.iter().position(|volumes| volumes.class == class);
        if let Some(place) = place.map(|place| place as u32) {
            pass.set_vertex_buffer(0, self.boxes.slice(..));
            pass.draw(0..BOX_CORNERS, place..place + 1);
        }
    }
}
