//! What both methods of drawing roads, and decks of bridges, have in common: an instance for each piece of a road, sorted by class, and a
//! pipeline that draws labels.

use std::ops::Range;

use corniche_roads::{FunctionalRoadClass, OwnWidth};
use wgpu::{
    BindGroup, BlendComponent, BlendFactor, BlendOperation, BlendState, Buffer, BufferUsages,
    ColorWrites, Device, FrontFace, PrimitiveTopology, RenderPass, RenderPipeline, VertexAttribute,
    VertexBufferLayout, VertexStepMode,
};

use super::{
    Gpu,
    formats::LABEL,
    pipeline::{PipelineRecipe, Shader},
    shared_bindings::{SharedBindings, SharedLayouts},
};
use crate::{
    options::ClassSet,
    tiles::{RoadEnd, RoadList},
};

/// The most important label stays, in whatever order roads are drawn.
const LARGEST: BlendComponent = BlendComponent {
    src_factor: BlendFactor::One,
    dst_factor: BlendFactor::One,
    operation: BlendOperation::Max,
};

/// A road's own width as an instance has it: metres above 0, lanes below it, 0 for neither.
pub(crate) fn own_width_value(own: OwnWidth) -> f32 {
    match own {
        OwnWidth::Unknown => 0.0,
        OwnWidth::Millimetres(mm) => (f64::from(mm.get()) / 1e3) as f32,
        OwnWidth::Lanes(lanes) => -f32::from(lanes.get()),
    }
}

/// Draws roads by one method into the labels.
pub(crate) struct RoadPipeline {
    pipeline: RenderPipeline,
    corners: Range<u32>,
}

impl RoadPipeline {
    /// The pipeline for pieces of a kind. `drawn` is the layout of what is bound at group 2. With `depth` that alone is drawn; without it labels are, of
    /// which the largest stays.
    pub(crate) fn new<T: RoadInstance>(
        device: &Device,
        layouts: &SharedLayouts,
        drawn: &wgpu::BindGroupLayout,
        entries: [&str; 2],
        depth: Option<wgpu::DepthStencilState>,
    ) -> Self {
        let largest = BlendState { color: LARGEST, alpha: LARGEST };
        let is_labelled = depth.is_none();
        let pipeline = PipelineRecipe {
            shader: T::SHADER,
            entries,
            groups: &[Some(&layouts.frame), Some(&layouts.tile), Some(drawn)],
            buffer: Some(VertexBufferLayout {
                array_stride: size_of::<T::Words>() as u64,
                step_mode: VertexStepMode::Instance,
                attributes: T::ATTRIBUTES,
            }),
            topology: PrimitiveTopology::TriangleStrip,
            front_face: FrontFace::Ccw,
            cull: T::CULL,
            depth,
            targets: if is_labelled { &[(LABEL, ColorWrites::ALL)] } else { &[] },
            blend: is_labelled.then_some(largest),
            constants: &[],
        };
        Self { pipeline: pipeline.build(device), corners: T::CORNERS }
    }

    /// Draws roads of some tiles, each given with its index in the list of tiles of the frame and the classes to draw. One
    /// draw per tile is enough, because the target keeps the largest label: neither the order of classes nor that of tiles matters.
    pub(crate) fn draw(
        &self,
        pass: &mut RenderPass<'_>,
        shared: &SharedBindings,
        drawn: &BindGroup,
        tiles: &[(usize, &RoadBuffers, ClassSet)],
    ) {
        self.begin(pass, shared, drawn);
        for (index, roads, classes) in tiles {
            shared.set_tile(pass, *index);
            roads.draw(pass, *classes, &self.corners);
        }
    }

    /// Draws instances that are in one buffer for all tiles: which of them belong to the tile with this index.
    pub(crate) fn draw_instances(
        &self,
        pass: &mut RenderPass<'_>,
        shared: &SharedBindings,
        drawn: &BindGroup,
        instances: &Buffer,
        by_tile: impl Iterator<Item = (usize, Range<u32>)>,
    ) {
        self.begin(pass, shared, drawn);
        pass.set_vertex_buffer(0, instances.slice(..));
        for (index, range) in by_tile {
            shared.set_tile(pass, index);
            pass.draw(self.corners.clone(), range);
        }
    }

    fn begin(&self, pass: &mut RenderPass<'_>, shared: &SharedBindings, drawn: &BindGroup) {
        pass.set_pipeline(&self.pipeline);
        shared.set_frame(pass);
        pass.set_bind_group(2, drawn, &[]);
    }
}

/// The roads of a tile on the graphics card, as one method draws them.
#[derive(Default)]
pub(crate) struct RoadBuffers {
    /// One instance for each piece, in order of class; `None` without roads.
    instances: Option<Buffer>,
    /// Which instances belong to each class.
    class_ranges: [Range<u32>; FunctionalRoadClass::COUNT],
    /// Where the roads meet the tile's border.
    pub(crate) ends: Vec<RoadEnd>,
}

/// A piece of a road or of a deck, which is one instance.
pub(crate) trait RoadInstance {
    /// The instance, as words.
    type Words: bytemuck::Pod;
    const SHADER: Shader;
    /// The words as the shader takes them.
    const ATTRIBUTES: &'static [VertexAttribute];
    /// Corners of the strip of triangles that is drawn for each instance.
    const CORNERS: Range<u32>;
    /// Which faces are not drawn.
    const CULL: Option<wgpu::Face>;
    /// The words of this piece.
    fn words(&self) -> Self::Words;
}

impl RoadBuffers {
    /// Uploads a list.
    pub(crate) fn new<T: RoadInstance>(gpu: &Gpu, list: &RoadList<T>) -> Self {
        let instances: Vec<T::Words> = list.all().iter().map(T::words).collect();
        let bytes: &[u8] = bytemuck::cast_slice(&instances);
        let mut class_ranges = [const { 0..0 }; FunctionalRoadClass::COUNT];
        for (class, range) in FunctionalRoadClass::all().zip(&mut class_ranges) {
            *range = list.range_of(class);
        }
        let instances =
            (!bytes.is_empty()).then(|| gpu.buffer("roads", bytes, BufferUsages::VERTEX));
        Self { instances, class_ranges, ends: list.ends().to_vec() }
    }

    /// Bytes of the buffer that a list takes.
    pub(crate) fn bytes_of<T: RoadInstance>(list: &RoadList<T>) -> u64 {
        (list.all().len() * size_of::<T::Words>()) as u64
    }

    /// Bytes of its buffer.
    pub(crate) fn gpu_bytes(&self) -> u64 {
        self.instances.as_ref().map_or(0, Buffer::size)
    }

    /// The instances of some classes, in as few ranges as possible.
    pub(crate) fn runs(&self, classes: ClassSet) -> Vec<Range<u32>> {
        let mut runs: Vec<Range<u32>> = Vec::new();
        for (class, range) in FunctionalRoadClass::all().zip(&self.class_ranges) {
            if range.is_empty() || !classes.contains(class) {
                continue;
            }
            match runs.last_mut() {
                Some(last) if last.end == range.start => last.end = range.end,
                _ => runs.push(range.clone()),
            }
        }
        runs
    }

    /// Draws the roads of these classes; an instance has these corners.
    fn draw(&self, pass: &mut RenderPass<'_>, classes: ClassSet, corners: &Range<u32>) {
        let Some(instances) = &self.instances else { return };
        pass.set_vertex_buffer(0, instances.slice(..));
        for range in self.runs(classes) {
            pass.draw(corners.clone(), range);
        }
    }
}

#[cfg(test)]
#[path = "road_instances_tests.rs"]
mod tests;
