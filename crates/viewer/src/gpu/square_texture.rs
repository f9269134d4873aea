//! A square texture is made of its texels.

use wgpu::{
    TextureFormat, TextureView,
    util::{DeviceExt as _, TextureDataOrder},
};

use super::Gpu;

/// A square texture with these texels.
pub(crate) fn square(gpu: &Gpu, format: TextureFormat, side: u32, texels: &[u8]) -> TextureView {
    let descriptor = wgpu::TextureDescriptor {
        label: Some("relief"),
        size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let order = TextureDataOrder::LayerMajor;
    let texture = gpu.device.create_texture_with_data(&gpu.queue, &descriptor, order, texels);
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
