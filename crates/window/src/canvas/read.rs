//! Pixels of the painted window, back from the graphics card.

use corniche_viewer::gpu::{Gpu, ReadBackError, read_texture};
use image::RgbaImage;
use wgpu::{TextureFormat, TextureUsages};

/// Something to paint into and read.
pub(super) fn texture(
    gpu: &Gpu,
    format: TextureFormat,
    [width, height]: [u32; 2],
) -> wgpu::Texture {
    gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: Some("picture of the window"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// Waits until it is painted and reads it.
pub(super) fn pixels(gpu: &Gpu, texture: &wgpu::Texture) -> Result<RgbaImage, ReadBackError> {
    let mut bytes = read_texture(gpu, texture)?;
    let has_blue_first =
        matches!(texture.format(), TextureFormat::Bgra8Unorm | TextureFormat::Bgra8UnormSrgb);
    let (pixels, _) = bytes.as_chunks_mut::<4>();
    for [a, _, b, opacity] in pixels {
        if has_blue_first {
            std::mem::swap(a, b);
        }
        // The window covers what is behind it.
        *opacity = 255;
    }
    // Four bytes for each pixel, so there is always an image.
    Ok(RgbaImage::from_raw(texture.width(), texture.height(), bytes).unwrap_or_default())
}
