//! Pixels of the painted window, back from the graphics card.

use corniche_viewer::gpu::{Gpu, ReadBackError};
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
    let (width, height) = (texture.width(), texture.height());
    let row_bytes = width * 4;
    let padded_bytes = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = gpu.device().create_buffer(&wgpu::BufferDescriptor {
        label: Some("picture of the window"),
        size: u64::from(padded_bytes) * u64::from(height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder =
        gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(padded_bytes),
                rows_per_image: Some(height),
            },
        },
        texture.size(),
    );
    gpu.queue().submit([encoder.finish()]);
    let (sender, receiver) = std::sync::mpsc::channel();
    buffer.slice(..).map_async(wgpu::MapMode::Read, move |result| {
        // The receiver outlives the wait below, so sending cannot fail.
        let _ = sender.send(result);
    });
    gpu.finish()?;
    if let Ok(Err(source)) = receiver.try_recv() {
        return Err(ReadBackError::Map { source });
    }
    let mapped =
        buffer.slice(..).get_mapped_range().map_err(|source| ReadBackError::Range { source })?;
    let has_blue_first =
        matches!(texture.format(), TextureFormat::Bgra8Unorm | TextureFormat::Bgra8UnormSrgb);
    Ok(RgbaImage::from_fn(width, height, |x, y| {
        let start = (y * padded_bytes + x * 4) as usize;
        let [a, green, b] = [mapped[start], mapped[start + 1], mapped[start + 2]];
        // The window covers what is behind it.
        image::Rgba(if has_blue_first { [b, green, a, 255] } else { [a, green, b, 255] })
    }))
}
