//! Photos of tiles on the graphics card.

use wgpu::{
    Device, Extent3d, FilterMode, Sampler, SamplerDescriptor, TextureDescriptor, TextureDimension,
    TextureFormat, TextureUsages, TextureView,
};

use super::Gpu;
use crate::tiles::PhotoImage;

/// Along a grazing view so many samples are averaged.
const ANISOTROPY: u16 = 16;

/// Colours are mixed as they are stored, like all others of the ground.
pub(crate) const FORMAT: TextureFormat = TextureFormat::Rgba8Unorm;

/// Uploads the photo of a tile as a texture of four sizes.
pub(crate) fn upload(gpu: &Gpu, photo: &PhotoImage) -> TextureView {
    let square = |side| Extent3d { width: side, height: side, depth_or_array_layers: 1 };
    let texture = gpu.device.create_texture(&TextureDescriptor {
        label: Some("photo"),
        size: square(photo.side),
        mip_level_count: PhotoImage::SIZES as u32,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format: FORMAT,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (level, (side, rgba)) in (0..).zip(photo.sizes()) {
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
            square(side),
        );
    }
    texture.create_view(&wgpu::TextureViewDescriptor::default())
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
