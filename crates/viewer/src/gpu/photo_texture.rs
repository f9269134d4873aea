//! Photos of tiles on the graphics card.

use wgpu::{
    Device, Extent3d, FilterMode, Sampler, SamplerDescriptor, TextureDescriptor, TextureDimension,
    TextureFormat, TextureUsages, TextureView,
};

use super::Gpu;
use crate::tiles::PhotoImage;

/// Along a grazing view so many samples are averaged.
const ANISOTROPY: u16 = 16;

/// The photo of a tile as a texture of four sizes.
pub(crate) struct PhotoTexture {
    view: TextureView,
}

impl PhotoTexture {
    /// For tiles without a photo: one texel, transparent, because textures begin with zeros.
    pub(crate) fn none(gpu: &Gpu) -> Self {
        let texture = new_texture(&gpu.device, 1, 1);
        Self { view: texture.create_view(&wgpu::TextureViewDescriptor::default()) }
    }

    /// Uploads a photo.
    pub(crate) fn new(gpu: &Gpu, photo: &PhotoImage) -> Self {
        let texture = new_texture(&gpu.device, photo.side, PhotoImage::SIZES as u32);
        for (level, rgba) in (0..).zip(&photo.sizes) {
            let side = photo.side >> level;
            gpu.queue.write_texture(
                wgpu::TexelCopyTextureInfo {
                    texture: &texture,
                    mip_level: level,
                    origin: wgpu::Origin3d::ZERO,
                    aspect: wgpu::TextureAspect::All,
                },
                rgba,
                wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(side * 4),
                    rows_per_image: Some(side),
                },
                Extent3d { width: side, height: side, depth_or_array_layers: 1 },
            );
        }
        Self { view: texture.create_view(&wgpu::TextureViewDescriptor::default()) }
    }

    /// What a bind group has of it.
    pub(crate) fn view(&self) -> &TextureView {
        &self.view
    }
}

/// The sampler of photos.
pub(crate) fn sampler(device: &Device) -> Sampler {
    device.create_sampler(&SamplerDescriptor {
        label: Some("photo"),
        mag_filter: FilterMode::Linear,
        min_filter: FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        anisotropy_clamp: ANISOTROPY,
        ..Default::default()
    })
}

fn new_texture(device: &Device, side: u32, sizes: u32) -> wgpu::Texture {
    device.create_texture(&TextureDescriptor {
        label: Some("photo"),
        size: Extent3d { width: side, height: side, depth_or_array_layers: 1 },
        mip_level_count: sizes,
        sample_count: 1,
        dimension: TextureDimension::D2,
        // Colours are mixed as they are stored, like all others of the ground.
        format: TextureFormat::Rgba8Unorm,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
        view_formats: &[],
    })
}
