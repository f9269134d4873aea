//! Layouts and bind groups of all drawables.

use wgpu::{
    BindGroup, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry,
    BindingResource, BindingType, BufferUsages, Device, ShaderStages, TextureSampleType,
    TextureView,
};

use super::Gpu;

/// Colours, labels and depths are read texel by texel. Depths are bound as ordinary numbers,
/// because the shading language of OpenGL cannot read depths texel by texel otherwise.
pub(crate) const UNFILTERED: TextureSampleType = TextureSampleType::Float { filterable: false };

/// Creates the layout of a bind group.
pub(crate) fn layout(
    device: &Device,
    label: &str,
    entries: &[BindGroupLayoutEntry],
) -> BindGroupLayout {
    device.create_bind_group_layout(&BindGroupLayoutDescriptor { label: Some(label), entries })
}

/// A uniform block for all stages. With `dynamic_bytes` it is one of many blocks of that size in
/// one buffer, and its offset is set when it is bound.
pub(crate) fn uniform(
    binding: u32,
    dynamic_bytes: Option<std::num::NonZeroU64>,
) -> BindGroupLayoutEntry {
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

/// A texture for the fragment stage.
pub(crate) fn texture(binding: u32, sample_type: TextureSampleType) -> BindGroupLayoutEntry {
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

/// Binds textures: the first at binding 0, the next at 1, and so on.
pub(crate) fn textures(gpu: &Gpu, layout: &BindGroupLayout, views: &[&TextureView]) -> BindGroup {
    let resources: Vec<_> = views.iter().map(|view| BindingResource::TextureView(view)).collect();
    group(gpu, layout, &resources)
}

/// Binds resources: the first at binding 0, the next at 1, and so on.
pub(crate) fn group(
    gpu: &Gpu,
    layout: &BindGroupLayout,
    resources: &[BindingResource<'_>],
) -> BindGroup {
    let entries: Vec<_> = resources
        .iter()
        .zip(0..)
        .map(|(resource, binding)| BindGroupEntry { binding, resource: resource.clone() })
        .collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout,
        entries: &entries,
    })
}

/// Uploads rows as a uniform block, and creates a bind group for it alone.
pub(crate) fn block(
    gpu: &Gpu,
    label: &str,
    layout: &BindGroupLayout,
    rows: &[[f32; 4]],
) -> BindGroup {
    let block = gpu.buffer(label, bytemuck::cast_slice(rows), BufferUsages::UNIFORM);
    group(gpu, layout, &[block.as_entire_binding()])
}
