//! The three pipelines and what they bind.

use wgpu::{
    BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry, BindingType, CompareFunction,
    DepthStencilState, Device, RenderPipeline, ShaderStages, TextureSampleType, VertexBufferLayout,
    VertexStepMode, vertex_attr_array,
};

use super::{
    targets::{COLOR, DEPTH, LABEL},
    tile_buffers::{GROUND_STRIDE, SEGMENT_STRIDE},
    uniforms::TILE_BYTES,
};

/// Shader sources by name, complete as compiled.
pub(super) const SHADERS: [(&str, &str); 3] = [
    (
        "terrain",
        concat!(include_str!("../shaders/common.wgsl"), include_str!("../shaders/terrain.wgsl")),
    ),
    (
        "roads",
        concat!(include_str!("../shaders/common.wgsl"), include_str!("../shaders/roads.wgsl")),
    ),
    (
        "composite",
        concat!(include_str!("../shaders/common.wgsl"), include_str!("../shaders/composite.wgsl")),
    ),
];

pub(super) struct Layouts {
    pub(super) frame: BindGroupLayout,
    pub(super) tile: BindGroupLayout,
    pub(super) depth: BindGroupLayout,
    pub(super) composite: BindGroupLayout,
}

pub(super) struct Pipelines {
    pub(super) terrain: RenderPipeline,
    pub(super) roads: RenderPipeline,
    pub(super) centers: RenderPipeline,
    pub(super) composite: RenderPipeline,
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
            depth: layout("depth", &[texture(0, TextureSampleType::Depth)]),
            composite: layout(
                "composite",
                &[
                    texture(0, TextureSampleType::Float { filterable: false }),
                    texture(1, TextureSampleType::Depth),
                    texture(2, TextureSampleType::Uint),
                ],
            ),
        }
    }
}

impl Pipelines {
    pub(super) fn new(device: &Device, layouts: &Layouts) -> Self {
        let ground_attributes = vertex_attr_array![0 => Float32x3, 1 => Snorm8x4];
        let segment_attributes = vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Uint32];
        let terrain = Recipe {
            shader: 0,
            groups: &[Some(&layouts.frame), Some(&layouts.tile)],
            buffer: Some(VertexBufferLayout {
                array_stride: GROUND_STRIDE,
                step_mode: VertexStepMode::Vertex,
                attributes: &ground_attributes,
            }),
            topology: wgpu::PrimitiveTopology::TriangleList,
            depth: Some(DepthStencilState {
                format: DEPTH,
                depth_write_enabled: Some(true),
                // Reversed depth: nearer is greater.
                depth_compare: Some(CompareFunction::Greater),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            target: COLOR,
            constants: &[],
        };
        let road_groups = [Some(&layouts.frame), Some(&layouts.tile), Some(&layouts.depth)];
        let roads = |constants| Recipe {
            shader: 1,
            groups: &road_groups,
            buffer: Some(VertexBufferLayout {
                array_stride: SEGMENT_STRIDE,
                step_mode: VertexStepMode::Instance,
                attributes: &segment_attributes,
            }),
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            depth: None,
            target: LABEL,
            constants,
        };
        let composite = Recipe {
            shader: 2,
            groups: &[Some(&layouts.frame), Some(&layouts.composite)],
            buffer: None,
            topology: wgpu::PrimitiveTopology::TriangleList,
            depth: None,
            target: COLOR,
            constants: &[],
        };
        Self {
            terrain: terrain.cook(device),
            roads: roads(&[("BAND", 0.0)]).cook(device),
            centers: roads(&[("BAND", 1.0)]).cook(device),
            composite: composite.cook(device),
        }
    }
}

/// What differs between the pipelines.
struct Recipe<'a> {
    shader: usize,
    groups: &'a [Option<&'a BindGroupLayout>],
    buffer: Option<VertexBufferLayout<'a>>,
    topology: wgpu::PrimitiveTopology,
    depth: Option<DepthStencilState>,
    target: wgpu::TextureFormat,
    constants: &'a [(&'a str, f64)],
}

impl Recipe<'_> {
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
        let buffers: Vec<_> = self.buffer.iter().cloned().map(Some).collect();
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(name),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: options.clone(),
                buffers: &buffers,
            },
            // Nothing is culled: from below the ground one sees its underside, and quads of roads face anywhere.
            primitive: wgpu::PrimitiveState { topology: self.topology, ..Default::default() },
            depth_stencil: self.depth.clone(),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fragment"),
                compilation_options: options,
                targets: &[Some(wgpu::ColorTargetState {
                    format: self.target,
                    // Roads overwrite each other: least important first, no blending.
                    blend: None,
                    write_mask: wgpu::ColorWrites::ALL,
                })],
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
mod tests {
    use super::SHADERS;

    /// Needs no GPU: every shader parses and is valid.
    #[test]
    fn every_shader_is_valid() {
        use wgpu::naga::{front::wgsl, valid};
        for (name, source) in SHADERS {
            let module = wgsl::parse_str(source).unwrap_or_else(|error| {
                panic!("{name}: {}", error.emit_to_string(source));
            });
            let mut validator = valid::Validator::new(
                valid::ValidationFlags::all(),
                valid::Capabilities::default(),
            );
            validator.validate(&module).unwrap_or_else(|error| {
                panic!("{name}: {}", error.emit_to_string(source));
            });
        }
    }

    /// Needs no GPU: the uniform block has as many rows as the shaders declare.
    #[test]
    fn the_frame_block_is_as_long_as_declared() {
        use wgpu::naga::{TypeInner, front::wgsl};
        let camera = crate::camera::Camera::look_at(
            glam::DVec3::ZERO,
            10.0,
            crate::camera::Orientation { heading_deg: 0.0, pitch_deg: 0.0 },
            [8, 8],
        );
        let style = crate::style::Style::road_atlas();
        let view = crate::gpu::FrameView {
            camera: &camera,
            style: &style,
            roads: crate::RoadMethod::None,
            exaggeration: 1.0,
            point_scale: 1.0,
            height_range_m: [0.0, 1.0],
            supersampling: 1,
        };
        let rows = crate::gpu::uniforms::frame_rows(&view).len();
        for (name, source) in SHADERS {
            let module = wgsl::parse_str(source).unwrap();
            let span = module.types.iter().find_map(|(_, ty)| match &ty.inner {
                TypeInner::Struct { span, .. } if ty.name.as_deref() == Some("Frame") => {
                    Some(*span)
                }
                _ => None,
            });
            assert_eq!(span, Some(rows as u32 * 16), "{name}");
        }
    }
}
