//! What both methods of drawing roads have in common: an instance for each piece of a road, sorted by class, and a pipeline
//! that keeps the largest label.

use std::ops::Range;

use corniche_roads::FunctionalRoadClass;
use wgpu::{
    BindGroupLayout, BlendComponent, BlendFactor, BlendOperation, BlendState, Buffer, BufferUsages,
    ColorWrites, PrimitiveTopology, RenderPass, VertexAttribute, VertexBufferLayout,
    VertexStepMode,
};

use super::{
    Gpu,
    formats::LABEL,
    pipeline::{ENTRIES, PipelineRecipe, Shader},
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

/// The shared bind groups, all three of which roads need.
pub(crate) fn road_groups(layouts: &SharedLayouts) -> [Option<&BindGroupLayout>; 3] {
    [Some(&layouts.frame), Some(&layouts.tile), Some(&layouts.ground)]
}

/// A pipeline that draws a strip of triangles for each instance into the labels.
pub(crate) fn road_recipe<'a>(
    shader: Shader,
    groups: &'a [Option<&'a BindGroupLayout>],
    instance_bytes: u64,
    attributes: &'a [VertexAttribute],
) -> PipelineRecipe<'a> {
    PipelineRecipe {
        shader,
        entries: ENTRIES,
        groups,
        buffer: Some(VertexBufferLayout {
            array_stride: instance_bytes,
            step_mode: VertexStepMode::Instance,
            attributes,
        }),
        topology: PrimitiveTopology::TriangleStrip,
        cull: None,
        depth: None,
        targets: &[(LABEL, ColorWrites::ALL)],
        blend: Some(BlendState { color: LARGEST, alpha: LARGEST }),
        constants: &[],
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

impl RoadBuffers {
    /// Uploads a list whose pieces are these bytes.
    pub(crate) fn new<T>(gpu: &Gpu, list: &RoadList<T>, bytes: &[u8]) -> Self {
        let mut class_ranges = [const { 0..0 }; FunctionalRoadClass::COUNT];
        for (class, range) in FunctionalRoadClass::all().zip(&mut class_ranges) {
            *range = list.range_of(class);
        }
        let instances =
            (!bytes.is_empty()).then(|| gpu.buffer("roads", bytes, BufferUsages::VERTEX));
        Self { instances, class_ranges, ends: list.ends().to_vec() }
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
    pub(crate) fn draw(&self, pass: &mut RenderPass<'_>, classes: ClassSet, corners: &Range<u32>) {
        let Some(instances) = &self.instances else { return };
        pass.set_vertex_buffer(0, instances.slice(..));
        for range in self.runs(classes) {
            pass.draw(corners.clone(), range);
        }
    }
}

/// Draws the roads of some tiles, each given with its index in the list of tiles of the frame. The pipeline is set. One
/// draw per tile is enough, because the target keeps the largest label: neither the order of classes nor that of tiles
/// matters.
pub(crate) fn draw_roads<'a>(
    pass: &mut RenderPass<'_>,
    shared: &SharedBindings,
    tiles: impl Iterator<Item = (usize, &'a RoadBuffers)>,
    classes: ClassSet,
    corners: &Range<u32>,
) {
    shared.set_frame(pass);
    shared.set_ground(pass);
    for (index, roads) in tiles {
        shared.set_tile(pass, index);
        roads.draw(pass, classes, corners);
    }
}

#[cfg(test)]
#[path = "road_instances_tests.rs"]
mod tests;
