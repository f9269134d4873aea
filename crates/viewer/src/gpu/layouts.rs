use wgpu::{
    BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry, BindingType, Device,
    ShaderStages, TextureSampleType,
};

use super::uniforms::TILE_BYTES;

/// Colours, labels and depths are read texel by texel; depths as numbers like others, for OpenGL's shading language
/// has no other way.
const UNFILTERED: TextureSampleType = TextureSampleType::Float { filterable: false };
/// What the shaders bind.
pub(crate) struct Layouts {
    pub(crate) frame: BindGroupLayout,
    pub(crate) tile: BindGroupLayout,
    pub(crate) ground: BindGroupLayout,
    pub(crate) blocks: BindGroupLayout,
    pub(crate) composite: BindGroupLayout,
    pub(crate) average: BindGroupLayout,
    pub(crate) difference: BindGroupLayout,
}

impl Layouts {
    pub(crate) fn new(device: &Device) -> Self {
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
                &[texture(0, UNFILTERED), texture(1, TextureSampleType::Uint)],
            ),
            blocks: layout("road blocks", &[texture(0, UNFILTERED)]),
            composite: layout(
                "composite",
                &[
                    texture(0, UNFILTERED),
                    texture(1, UNFILTERED),
                    texture(2, UNFILTERED),
                    BindGroupLayoutEntry {
                        visibility: ShaderStages::VERTEX,
                        ..texture(3, UNFILTERED)
                    },
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
