//! Common parts of both methods of drawing roads, and of decks of bridges: an instance for each
//! piece of a road, sorted by class, and a pipeline that draws labels.

use std::ops::Range;

use corniche_roads::{FunctionalRoadClass, OwnWidth};
use wgpu::{
    BindGroup, BlendComponent, BlendFactor, BlendOperation, BlendState, Buffer, BufferUsages,
    ColorWrites, Device, PrimitiveTopology, RenderPass, RenderPipeline, VertexAttribute,
    VertexStepMode,
};

use super::{
    Gpu,
    formats::LABEL,
    pipeline::{PipelineRecipe, Shader, vertex_layout},
    shared_bindings::{SharedBindings, SharedLayouts},
};
use crate::{
    options::ClassSet,
    tiles::{RoadEnd, RoadKind, RoadList},
};

/// Keeps the most important label, in any order of drawing.
const LARGEST: BlendComponent = BlendComponent {
    src_factor: BlendFactor::One,
    dst_factor: BlendFactor::One,
    operation: BlendOperation::Max,
};

/// Encodes a road's own width for an instance: metres above 0, lanes below 0, 0 for no own width.
pub(crate) fn own_width_value(own: OwnWidth) -> f32 {
    match own {
        OwnWidth::Unknown => 0.0,
        OwnWidth::Millimetres(mm) => (f64::from(mm.get()) / 1e3) as f32,
        OwnWidth::Lanes(lanes) => -f32::from(lanes.get()),
    }
}

/// Encodes class and look of a road, and a bit for each end; shaders read them from the lowest nine
/// bits.
pub(crate) fn kind_bits(RoadKind { class, look, .. }: RoadKind, ends: [bool; 2]) -> u32 {
    let [start, end] = ends.map(u32::from);
    u32::from(class.number()) | (look as u32) << 4 | start << 7 | end << 8
}

/// Draws the labels of roads with one method.
pub(crate) struct RoadPipeline {
    pipeline: RenderPipeline,
    corners: Range<u32>,
}

impl RoadPipeline {
    /// Creates the pipeline for one kind of pieces. `drawn` is the layout of bind group 2. With
    /// `depth` only depth is drawn; without it labels are drawn, and the largest label stays.
    pub(crate) fn new<T: RoadInstance>(
        device: &Device,
        layouts: &SharedLayouts,
        drawn: &wgpu::BindGroupLayout,
        entries: [&str; 2],
        depth: Option<wgpu::DepthStencilState>,
    ) -> Self {
        let largest = BlendState { color: LARGEST, alpha: LARGEST };
        let is_labelled = depth.is_none();
        let groups = [Some(&layouts.frame), Some(&layouts.tile), Some(drawn)];
        let pipeline = PipelineRecipe {
            entries,
            buffer: Some(vertex_layout::<T::Words>(VertexStepMode::Instance, T::ATTRIBUTES)),
            topology: PrimitiveTopology::TriangleStrip,
            cull: T::CULL,
            depth,
            targets: if is_labelled { &[(LABEL, ColorWrites::ALL)] } else { &[] },
            blend: is_labelled.then_some(largest),
            ..PipelineRecipe::new(T::SHADER, &groups, &[])
        };
        Self { pipeline: pipeline.build(device), corners: T::CORNERS }
    }

    /// Draws the roads of some tiles, each given with its index in the list of tiles of the frame
    /// and the classes to draw. One draw call per tile is enough, because the target keeps the
    /// largest label: the order of classes and tiles has no effect.
    pub(crate) fn draw(
        &self,
        pass: &mut RenderPass<'_>,
        shared: &SharedBindings,
        drawn: &BindGroup,
        tiles: &[RoadsOfTile<'_>],
    ) {
        self.begin(pass, shared, drawn);
        for RoadsOfTile { tile, roads, classes } in tiles {
            shared.set_tile(pass, *tile);
            roads.draw(pass, *classes, &self.corners);
        }
    }

    /// Draws a range of instances from one buffer for all tiles; the range belongs to the tile with
    /// this index.
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

/// The roads of a tile to draw.
pub(crate) struct RoadsOfTile<'a> {
    /// The index of the tile in the list of tiles of the frame.
    pub(crate) tile: usize,
    pub(crate) roads: &'a RoadBuffers,
    /// The classes to draw.
    pub(crate) classes: ClassSet,
}

/// The roads of a tile on the GPU, for one method.
#[derive(Default)]
pub(crate) struct RoadBuffers {
    /// One instance for each piece, in order of class; `None` without roads.
    instances: Option<Buffer>,
    /// The range of instances of each class.
    class_ranges: [Range<u32>; FunctionalRoadClass::COUNT],
    /// Points where the roads meet the tile's border.
    pub(crate) ends: Vec<RoadEnd>,
}

/// A piece of a road or of a deck, drawn as one instance.
pub(crate) trait RoadInstance {
    /// The words of an instance.
    type Words: bytemuck::Pod;
    const SHADER: Shader;
    /// The layout of the words for the shader.
    const ATTRIBUTES: &'static [VertexAttribute];
    /// Corners of the triangle strip that is drawn for each instance.
    const CORNERS: Range<u32>;
    /// The faces to cull.
    const CULL: Option<wgpu::Face>;
    /// The words of this piece.
    fn words(&self) -> Self::Words;
}

impl RoadBuffers {
    /// Uploads a list.
    pub(crate) fn new<T: RoadInstance>(gpu: &Gpu, list: &RoadList<T>) -> Self {
        let instances: Vec<T::Words> = list.all().iter().map(T::words).collect();
        let bytes: &[u8] = bytemuck::cast_slice(&instances);
        let instances =
            (!bytes.is_empty()).then(|| gpu.buffer("roads", bytes, BufferUsages::VERTEX));
        Self { instances, class_ranges: list.ranges.clone(), ends: list.ends().to_vec() }
    }

    /// Size of the buffer for a list, bytes.
    pub(crate) fn bytes_of<T: RoadInstance>(list: &RoadList<T>) -> u64 {
        (list.all().len() * size_of::<T::Words>()) as u64
    }

    /// Size of the buffer, bytes.
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

    /// Draws the roads of these classes; `corners` are the corners of an instance.
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
