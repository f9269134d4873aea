//! A texture into which passes draw, with its only view.

use wgpu::{TextureFormat, TextureUsages, TextureView};

use super::{Gpu, ReadBackError, read_back::read_texture};

/// A texture and its only view.
pub(crate) struct TargetTexture {
    pub(crate) texture: wgpu::Texture,
    pub(crate) view: TextureView,
}

impl TargetTexture {
    /// Creates a texture that can be drawn into, bound and read back.
    pub(crate) fn new(gpu: &Gpu, label: &str, format: TextureFormat, size_px: [u32; 2]) -> Self {
        let usage = TextureUsages::RENDER_ATTACHMENT
            | TextureUsages::TEXTURE_BINDING
            | TextureUsages::COPY_SRC;
        let texture = gpu.texture(label, format, size_px, 1, usage);
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Self { texture, view }
    }

    /// Reads the texels, row by row from the top.
    pub(crate) fn read(&self, gpu: &Gpu) -> Result<Vec<u8>, ReadBackError> {
        read_texture(gpu, &self.texture)
    }
}
