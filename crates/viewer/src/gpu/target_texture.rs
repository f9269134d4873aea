//! A texture that passes draw into, with its only view.

use wgpu::{Extent3d, TextureFormat, TextureUsages, TextureView};

use super::{Gpu, ReadBackError, read_back::read_texture};

/// A texture and its only view.
pub(crate) struct TargetTexture {
    texture: wgpu::Texture,
    pub(crate) view: TextureView,
}

impl TargetTexture {
    /// A texture that can be drawn into, bound and read back.
    pub(crate) fn new(gpu: &Gpu, label: &str, format: TextureFormat, size_px: [u32; 2]) -> Self {
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: Extent3d { width: size_px[0], height: size_px[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: TextureUsages::RENDER_ATTACHMENT
                | TextureUsages::TEXTURE_BINDING
                | TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Self { texture, view }
    }

    /// The texture.
    pub(crate) fn texture(&self) -> &wgpu::Texture {
        &self.texture
    }

    /// Its texels, row by row from the top.
    pub(crate) fn read(&self, gpu: &Gpu) -> Result<Vec<u8>, ReadBackError> {
        read_texture(gpu, &self.texture)
    }
}
