//! The pipelines and what they bind.

use wgpu::{
    BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry, BindingType, CompareFunction,
    DepthStencilState, Device, PrimitiveTopology, RenderPipeline, ShaderStages, TextureSampleType,
    VertexBufferLayout, VertexStepMode, vertex_attr_array,
};

use super::{
    targets::{COLOR, DEPTH, LABEL, OWNER},
    tile_buffers::{GROUND_STRIDE, SEGMENT_STRIDE, VOLUME_STRIDE},
    uniforms::TILE_BYTES,
};

macro_rules! shader {
    ($($file:literal),+) => {
        concat!($(include_str!(concat!("../shaders/", $file, ".wgsl"))),+)
    };
}

/// Shader sources by name, complete as compiled.
pub(super) const SHADERS: [(&str, &str); 4] = [
    ("terrain", shader!("common", "terrain")),
    ("roads", shader!("common", "coverage", "roads")),
    ("volumes", shader!("common", "coverage", "volumes")),
    ("composite", shader!("common", "composite")),
];

pub(super) struct Layouts {
    pub(super) frame: BindGroupLayout,
    pub(super) tile: BindGroupLayout,
    pub(super) ground: BindGroupLayout,
    pub(super) composite: BindGroupLayout,
}

pub(super) struct Pipelines {
    pub(super) terrain: RenderPipeline,
    pub(super) skirts: RenderPipeline,
    pub(super) segments: RoadPipelines,
    pub(super) volumes: RoadPipelines,
    pub(super) composite: RenderPipeline,
}

/// The same for a whole road and for the line along its middle.
pub(super) struct RoadPipelines {
    pub(super) fills: RenderPipeline,
    pub(super) centers: RenderPipeline,
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
        let volume_attributes =
            vertex_attr_array![0 => Float32x2, 1 => Float32x2, 2 => Float32x2, 3 => Uint32];
        let terrain_groups = [Some(&layouts.frame), Some(&layouts.tile)];
        let terrain = |constants| Recipe {
            shader: 0,
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
            targets: &[COLOR, OWNER],
            constants,
        };
        let road_groups = [Some(&layouts.frame), Some(&layouts.tile), Some(&layouts.ground)];
        let segments = |constants| Recipe {
            shader: 1,
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
            targets: &[LABEL],
            constants,
        };
        let volumes = |constants| Recipe {
            shader: 2,
            buffer: Some(VertexBufferLayout {
                array_stride: VOLUME_STRIDE,
                step_mode: VertexStepMode::Instance,
                attributes: &volume_attributes,
            }),
            // One fragment per pixel and box, also with the eye inside: the far faces.
            cull: Some(wgpu::Face::Front),
            ..segments(constants)
        };
        let composite = Recipe {
            shader: 3,
            groups: &[Some(&layouts.frame), Some(&layouts.composite)],
            buffer: None,
            topology: PrimitiveTopology::TriangleList,
            cull: None,
            depth: None,
            targets: &[COLOR],
            constants: &[],
        };
        let both = |recipe: &dyn Fn(&'static [(&'static str, f64)]) -> RenderPipeline| {
            RoadPipelines { fills: recipe(&[("BAND", 0.0)]), centers: recipe(&[("BAND", 1.0)]) }
        };
        Self {
            terrain: terrain(&[("SKIRT", 0.0)]).cook(device),
            skirts: terrain(&[("SKIRT", 1.0)]).cook(device),
            segments: both(&|constants| segments(constants).cook(device)),
            volumes: both(&|constants| volumes(constants).cook(device)),
            composite: composite.cook(device),
        }
    }
}

/// What differs between the pipelines.
struct Recipe<'a> {
    shader: usize,
    groups: &'a [Option<&'a BindGroupLayout>],
    buffer: Option<VertexBufferLayout<'a>>,
    topology: PrimitiveTopology,
    cull: Option<wgpu::Face>,
    depth: Option<DepthStencilState>,
    targets: &'a [wgpu::TextureFormat],
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
        let targets: Vec<_> = self
            .targets
            .iter()
            .map(|format| {
                Some(wgpu::ColorTargetState {
                    format: *format,
                    // Roads overwrite each other: least important first, no blending.
                    blend: None,
                    write_mask: wgpu::ColorWrites::ALL,
                })
            })
            .collect();
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
            primitive: wgpu::PrimitiveState {
                topology: self.topology,
                cull_mode: self.cull,
                ..Default::default()
            },
            depth_stencil: self.depth.clone(),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fragment"),
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
            roads: crate::RoadOptions::of(crate::RoadMethod::None),
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

    /// Needs no GPU: every face of a volume's box is drawn, its corners counter-clockwise seen from outside.
    #[test]
    fn the_strip_of_a_volume_goes_around_its_box() {
        let source = SHADERS[2].1;
        let list = source.split("STRIP = array<u32, 14>(").nth(1).unwrap().split(')').next();
        let strip: Vec<u32> = list
            .unwrap()
            .split(',')
            .map(|k| k.trim().trim_end_matches('u').parse().unwrap())
            .collect();
        let corner = |k: u32| {
            glam::Vec3::from_array([0, 1, 2].map(|bit| if k >> bit & 1 == 1 { 1.0 } else { -1.0 }))
        };
        let mut area_by_face = std::collections::BTreeMap::new();
        for (index, three) in strip.windows(3).enumerate() {
            let [a, b, c] = [three[0], three[1], three[2]].map(corner);
            let flip = if index % 2 == 0 { 1.0 } else { -1.0 };
            let normal = (b - a).cross(c - a) * flip;
            assert!(normal.dot(a + b + c) > 0.0, "triangle {index} faces inwards");
            let face = normal.normalize().round().to_array().map(|part| part as i8);
            *area_by_face.entry(face).or_insert(0.0) += normal.length() / 2.0;
        }
        assert_eq!(area_by_face.into_values().collect::<Vec<f32>>(), [4.0; 6]);
    }
}
