//! The pipelines and what they bind.

use wgpu::{
    BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry, BindingType, BlendComponent,
    BlendFactor, BlendOperation, BlendState, ColorWrites, CompareFunction, DepthStencilState,
    Device, PrimitiveTopology, RenderPipeline, ShaderStages, TextureSampleType, VertexBufferLayout,
    VertexStepMode, vertex_attr_array,
};

use super::{
    picture::{COLOR, MAX_SAMPLES_PER_SIDE},
    targets::{DEPTH, LABEL, OWNER},
    tile_buffers::{GROUND_STRIDE, SEGMENT_STRIDE, VOLUME_STRIDE},
    uniforms::TILE_BYTES,
};

macro_rules! shader {
    ($($file:literal),+) => {
        concat!($(include_str!(concat!("../shaders/", $file, ".wgsl"))),+)
    };
}

/// Shader sources by name, complete as compiled.
pub(super) const SHADERS: [(&str, &str); 6] = [
    ("terrain", shader!("common", "terrain")),
    ("roads", shader!("common", "coverage", "roads")),
    ("volumes", shader!("common", "coverage", "volumes")),
    ("composite", shader!("common", "screen", "composite")),
    ("average", shader!("screen", "average")),
    ("difference", shader!("screen", "difference")),
];

/// Colours and labels are read texel by texel.
const UNFILTERED: TextureSampleType = TextureSampleType::Float { filterable: false };
/// The most important label stays, in whatever order roads are drawn.
const LARGEST: BlendComponent = BlendComponent {
    src_factor: BlendFactor::One,
    dst_factor: BlendFactor::One,
    operation: BlendOperation::Max,
};

pub(super) struct Layouts {
    pub(super) frame: BindGroupLayout,
    pub(super) tile: BindGroupLayout,
    pub(super) ground: BindGroupLayout,
    pub(super) composite: BindGroupLayout,
    pub(super) average: BindGroupLayout,
    pub(super) difference: BindGroupLayout,
}

pub(super) struct Pipelines {
    pub(super) terrain: RenderPipeline,
    pub(super) skirts: RenderPipeline,
    pub(super) wires: RenderPipeline,
    pub(super) segments: RenderPipeline,
    pub(super) volumes: RenderPipeline,
    pub(super) composite: RenderPipeline,
    /// Of 2, 3 and 4 samples on each side of a pixel.
    pub(super) averages: [RenderPipeline; MAX_SAMPLES_PER_SIDE as usize - 1],
    pub(super) difference: RenderPipeline,
}

impl Layouts {
    pub(super) fn new(device: &Device) -> Self {
        let layout = |label, entries: &[BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&BindGroupLayoutDescriptor {
                label: Some(label),
                entries,
            })
        };
        Self {
            frame: layout("frame", &[uniform(0, None)]),
            tile: layout("tile", &[uniform(0, std::num::NonZeroU64::new(TILE_BYTES))]),
            ground: layout(
                "ground",
                &[texture(0, TextureSampleType::Depth), texture(1, TextureSampleType::Uint)],
            ),
            composite: layout(
                "composite",
                &[
                    texture(0, UNFILTERED),
                    texture(1, TextureSampleType::Depth),
                    texture(2, UNFILTERED),
                ],
            ),
            average: layout("average", &[texture(0, UNFILTERED)]),
            difference: layout(
                "difference",
                &[texture(0, UNFILTERED), texture(1, UNFILTERED), texture(2, UNFILTERED)],
            ),
        }
    }
}

impl Pipelines {
    pub(super) fn new(device: &Device, layouts: &Layouts) -> Self {
        let ground_attributes = vertex_attr_array![0 => Float32x3, 1 => Snorm8x4];
        let segment_attributes = vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Uint32];
        let volume_attributes =
            vertex_attr_array![0 => Float32x2, 1 => Float32x2, 2 => Float32x2, 3 => Uint32];
        let terrain_groups = [Some(&layouts.frame), Some(&layouts.tile)];
        let terrain = |constants| Recipe {
            shader: 0,
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
            shader: 1,
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
            shader: 2,
            buffer: Some(VertexBufferLayout {
                array_stride: VOLUME_STRIDE,
                step_mode: VertexStepMode::Instance,
                attributes: &volume_attributes,
            }),
            // One fragment per pixel and box, also with the eye inside: the far faces.
            cull: Some(wgpu::Face::Front),
            ..segments.clone()
        };
        let composite_groups = [Some(&layouts.frame), Some(&layouts.composite)];
        let average_groups = [Some(&layouts.average)];
        let average = |per_side| {
            Recipe::full_screen(4, &average_groups, &[("PER_SIDE", per_side)]).cook(device)
        };
        Self {
            terrain: terrain(&[("SKIRT", 0.0)]).cook(device),
            skirts: terrain(&[("SKIRT", 1.0)]).cook(device),
            wires: wires.cook(device),
            segments: segments.cook(device),
            volumes: volumes.cook(device),
            composite: Recipe::full_screen(3, &composite_groups, &[]).cook(device),
            averages: [average(2.0), average(3.0), average(4.0)],
            difference: Recipe::full_screen(5, &[Some(&layouts.difference)], &[]).cook(device),
        }
    }
}

/// What most shaders call theirs.
const ENTRIES: [&str; 2] = ["vertex", "fragment"];

/// What differs between the pipelines.
#[derive(Clone)]
struct Recipe<'a> {
    shader: usize,
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
        shader: usize,
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
        let (name, source) = SHADERS[self.shader];
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

fn uniform(binding: u32, dynamic_bytes: Option<std::num::NonZeroU64>) -> BindGroupLayoutEntry {
    BindGroupLayoutEntry {
        binding,
        visibility: ShaderStages::VERTEX_FRAGMENT,
        ty: BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: dynamic_bytes.is_some(),
            min_binding_size: dynamic_bytes,
        },
        count: None,
    }
}

fn texture(binding: u32, sample_type: TextureSampleType) -> BindGroupLayoutEntry {
    BindGroupLayoutEntry {
        binding,
        visibility: ShaderStages::FRAGMENT,
        ty: BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    }
}

#[cfg(test)]
#[path = "passes_tests.rs"]
mod tests;
