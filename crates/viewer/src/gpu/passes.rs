//! The pipelines.

use wgpu::{
    BindGroupLayout, BlendComponent, BlendFactor, BlendOperation, BlendState, ColorWrites,
    CompareFunction, DepthStencilState, Device, PrimitiveTopology, RenderPipeline,
    VertexBufferLayout, VertexStepMode, vertex_attr_array,
};

use super::{
    layouts::Layouts,
    picture::{COLOR, MAX_SAMPLES_PER_SIDE},
    targets::{BLOCK, DEPTH, LABEL, OWNER},
    tile_buffers::{GROUND_STRIDE, SEGMENT_STRIDE, VOLUME_STRIDE},
};

macro_rules! shader {
    ($($file:literal),+) => {
        concat!($(include_str!(concat!("../shaders/", $file, ".wgsl"))),+)
    };
}

/// A shader's name and its source, complete as compiled.
type Shader = (&'static str, &'static str);

const TERRAIN: Shader = ("terrain", shader!("common", "terrain"));
const ROADS: Shader = ("roads", shader!("common", "coverage", "roads"));
const VOLUMES: Shader = ("volumes", shader!("common", "coverage", "volumes"));
const BLOCKS: Shader = ("road blocks", shader!("common", "screen", "blocks"));
const COMPOSITE: Shader = ("composite", shader!("common", "screen", "composite"));
const AVERAGE: Shader = ("average", shader!("screen", "average"));
const DIFFERENCE: Shader = ("difference", shader!("screen", "difference"));

/// The most important label stays, in whatever order roads are drawn.
const LARGEST: BlendComponent = BlendComponent {
    src_factor: BlendFactor::One,
    dst_factor: BlendFactor::One,
    operation: BlendOperation::Max,
};

pub(crate) struct Pipelines {
    pub(crate) terrain: RenderPipeline,
    pub(crate) skirts: RenderPipeline,
    pub(crate) wires: RenderPipeline,
    pub(crate) segments: RenderPipeline,
    pub(crate) volumes: RenderPipeline,
    pub(crate) blocks: RenderPipeline,
    /// Ground and sky, everywhere.
    pub(crate) composite: RenderPipeline,
    /// The same with roads, block by block.
    pub(crate) composite_roads: RenderPipeline,
    /// Of 2, 3 and 4 samples on each side of a pixel.
    pub(crate) averages: [RenderPipeline; MAX_SAMPLES_PER_SIDE as usize - 1],
    pub(crate) difference: RenderPipeline,
}

impl Pipelines {
    pub(crate) fn new(device: &Device, layouts: &Layouts) -> Self {
        let ground_attributes = vertex_attr_array![0 => Float32x3, 1 => Snorm8x4];
        let segment_attributes = vertex_attr_array![
            0 => Float32x4, 1 => Float32x4, 2 => Float32x2, 3 => Uint32, 4 => Float16x4, 5 => Float16x4
        ];
        let volume_attributes = vertex_attr_array![
            0 => Float32x2, 1 => Float32x2, 2 => Float32x2, 3 => Float32x2, 4 => Float32x2, 5 => Uint32
        ];
        let terrain_groups = [Some(&layouts.frame), Some(&layouts.tile)];
        let terrain = |constants| Recipe {
            shader: TERRAIN,
            entries: ENTRIES,
            groups: &terrain_groups,
            buffer: Some(VertexBufferLayout {
                array_stride: GROUND_STRIDE,
                step_mode: VertexStepMode::Vertex,
                attributes: &ground_attributes,
            }),
            topology: PrimitiveTopology::TriangleList,
            // From below the ground one sees its underside.
            cull: None,
            depth: Some(DepthStencilState {
                format: DEPTH,
                depth_write_enabled: Some(true),
                // Reversed depth: nearer is greater.
                depth_compare: Some(CompareFunction::Greater),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            targets: &[(COLOR, ColorWrites::ALL), (OWNER, ColorWrites::ALL)],
            blend: None,
            constants,
        };
        let wires = Recipe {
            entries: ["vertex", "wire_fragment"],
            topology: PrimitiveTopology::LineList,
            depth: Some(DepthStencilState {
                format: DEPTH,
                depth_write_enabled: Some(false),
                depth_compare: Some(CompareFunction::GreaterEqual),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            // Alpha and owner still say that there is ground.
            targets: &[(COLOR, ColorWrites::COLOR), (OWNER, ColorWrites::empty())],
            ..terrain(&[("PULL_PX", 2.0)])
        };
        let road_groups = [Some(&layouts.frame), Some(&layouts.tile), Some(&layouts.ground)];
        let segments = Recipe {
            shader: ROADS,
            entries: ENTRIES,
            groups: &road_groups,
            buffer: Some(VertexBufferLayout {
                array_stride: SEGMENT_STRIDE,
                step_mode: VertexStepMode::Instance,
                attributes: &segment_attributes,
            }),
            topology: PrimitiveTopology::TriangleStrip,
            // Quads face anywhere.
            cull: None,
            depth: None,
            targets: &[(LABEL, ColorWrites::ALL)],
            blend: Some(BlendState { color: LARGEST, alpha: LARGEST }),
            constants: &[],
        };
        let volumes = Recipe {
            shader: VOLUMES,
            buffer: Some(VertexBufferLayout {
                array_stride: VOLUME_STRIDE,
                step_mode: VertexStepMode::Instance,
                attributes: &volume_attributes,
            }),
            // One fragment per pixel and box, also with the eye inside: the far faces.
            cull: Some(wgpu::Face::Front),
            ..segments.clone()
        };
        let block = [("BLOCK", f64::from(BLOCK))];
        let blocks_groups = [Some(&layouts.frame), Some(&layouts.blocks)];
        let blocks = Recipe {
            targets: &[(LABEL, ColorWrites::ALL)],
            ..Recipe::full_screen(BLOCKS, &blocks_groups, &block)
        };
        let composite_groups = [Some(&layouts.frame), Some(&layouts.composite)];
        let composite = |entries| Recipe {
            entries,
            ..Recipe::full_screen(COMPOSITE, &composite_groups, &block)
        };
        let average_groups = [Some(&layouts.average)];
        let average = |per_side| {
            Recipe::full_screen(AVERAGE, &average_groups, &[("PER_SIDE", per_side)]).cook(device)
        };
        Self {
            terrain: terrain(&[("SKIRT", 0.0)]).cook(device),
            skirts: terrain(&[("SKIRT", 1.0)]).cook(device),
            wires: wires.cook(device),
            segments: segments.cook(device),
            volumes: volumes.cook(device),
            blocks: blocks.cook(device),
            composite: composite(["vertex", "ground_fragment"]).cook(device),
            composite_roads: composite(["block_vertex", "road_fragment"]).cook(device),
            averages: [average(2.0), average(3.0), average(4.0)],
            difference: Recipe::full_screen(DIFFERENCE, &[Some(&layouts.difference)], &[])
                .cook(device),
        }
    }
}

/// What most shaders call theirs.
const ENTRIES: [&str; 2] = ["vertex", "fragment"];

/// What differs between the pipelines.
#[derive(Clone)]
struct Recipe<'a> {
    shader: Shader,
    /// Names of the vertex and the fragment shader.
    entries: [&'a str; 2],
    groups: &'a [Option<&'a BindGroupLayout>],
    buffer: Option<VertexBufferLayout<'a>>,
    topology: PrimitiveTopology,
    cull: Option<wgpu::Face>,
    depth: Option<DepthStencilState>,
    targets: &'a [(wgpu::TextureFormat, ColorWrites)],
    blend: Option<BlendState>,
    constants: &'a [(&'a str, f64)],
}

impl<'a> Recipe<'a> {
    /// One triangle over all of a picture.
    fn full_screen(
        shader: Shader,
        groups: &'a [Option<&'a BindGroupLayout>],
        constants: &'a [(&'a str, f64)],
    ) -> Self {
        Self {
            shader,
            entries: ENTRIES,
            groups,
            buffer: None,
            topology: PrimitiveTopology::TriangleList,
            cull: None,
            depth: None,
            targets: &[(COLOR, ColorWrites::ALL)],
            blend: None,
            constants,
        }
    }

    fn cook(&self, device: &Device) -> RenderPipeline {
        let (name, source) = self.shader;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(name),
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(name),
            bind_group_layouts: self.groups,
            immediate_size: 0,
        });
        let options =
            wgpu::PipelineCompilationOptions { constants: self.constants, ..Default::default() };
        let targets: Vec<_> = self
            .targets
            .iter()
            .map(|(format, write_mask)| {
                Some(wgpu::ColorTargetState {
                    format: *format,
                    blend: self.blend,
                    write_mask: *write_mask,
                })
            })
            .collect();
        let buffers: Vec<_> = self.buffer.iter().cloned().map(Some).collect();
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(name),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(self.entries[0]),
                compilation_options: options.clone(),
                buffers: &buffers,
            },
            primitive: wgpu::PrimitiveState {
                topology: self.topology,
                cull_mode: self.cull,
                ..Default::default()
            },
            depth_stencil: self.depth.clone(),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(self.entries[1]),
                compilation_options: options,
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

#[cfg(test)]
#[path = "passes_tests.rs"]
mod tests;
