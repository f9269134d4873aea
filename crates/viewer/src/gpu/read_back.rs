use wgpu::{BufferUsages, Origin3d, TexelCopyBufferInfo, TexelCopyBufferLayout};

use super::{Gpu, ReadBackError};

/// Texels of a texture, row by row from the top, without gaps. Waits until it is drawn.
///
/// The texture can be copied from, and its format has one plane of whole texels.
///
/// # Errors
/// When the device is lost or could not draw.
pub fn read_texture(gpu: &Gpu, texture: &wgpu::Texture) -> Result<Vec<u8>, ReadBackError> {
    read_in_bands(gpu, texture, gpu.device.limits().max_buffer_size)
}

/// The same by bands of rows that take no more than `most_bytes` each, though always a row: the largest pictures are
/// larger than a buffer may be.
fn read_in_bands(
    gpu: &Gpu,
    texture: &wgpu::Texture,
    most_bytes: u64,
) -> Result<Vec<u8>, ReadBackError> {
    let (width, height) = (texture.width(), texture.height());
    let texel_bytes = texture.format().block_copy_size(None).unwrap_or(4);
    let row_bytes = width * texel_bytes;
    let padded_bytes = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    // No more than the texture's height, which is a u32.
    let band_rows = (most_bytes / u64::from(padded_bytes)).clamp(1, u64::from(height)) as u32;
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read back"),
        size: u64::from(padded_bytes) * u64::from(band_rows),
        usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut rows = Vec::with_capacity(row_bytes as usize * height as usize);
    let mut top = 0;
    while top < height {
        let band_rows = band_rows.min(height - top);
        let descriptor = wgpu::CommandEncoderDescriptor { label: Some("read back") };
        let mut encoder = gpu.device.create_command_encoder(&descriptor);
        encoder.copy_texture_to_buffer(
            wgpu::TexelCopyTextureInfo {
                origin: Origin3d { x: 0, y: top, z: 0 },
                ..texture.as_image_copy()
            },
            TexelCopyBufferInfo {
                buffer: &buffer,
                layout: TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(padded_bytes),
                    rows_per_image: Some(band_rows),
                },
            },
            wgpu::Extent3d { width, height: band_rows, depth_or_array_layers: 1 },
        );
        gpu.queue.submit([encoder.finish()]);
        let (sender, receiver) = std::sync::mpsc::channel();
        buffer.slice(..).map_async(wgpu::MapMode::Read, move |result| {
            // The receiver outlives the wait below, so sending cannot fail.
            let _ = sender.send(result);
        });
        gpu.finish()?;
        if let Ok(Err(source)) = receiver.try_recv() {
            return Err(ReadBackError::Map { source });
        }
        let mapped = buffer
            .slice(..)
            .get_mapped_range()
            .map_err(|source| ReadBackError::Range { source })?;
        for row in mapped.chunks_exact(padded_bytes as usize).take(band_rows as usize) {
            rows.extend_from_slice(&row[..row_bytes as usize]);
        }
        drop(mapped);
        buffer.unmap();
        top += band_rows;
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::GpuError;

    /// 37 × 11 texels of ascending bytes, by bands of all rows, some, the last one shorter, and one each.
    #[test]
    fn bands_add_up_to_the_picture() {
        let gpu = match Gpu::new() {
            Ok(gpu) => gpu,
            Err(error @ GpuError::NoAdapter { .. }) => {
                assert!(std::env::var_os("CORNICHE_REQUIRE_GPU").is_none(), "{error}");
                eprintln!("skipped: {error}");
                return;
            }
            Err(error) => panic!("{error}"),
        };
        let size = wgpu::Extent3d { width: 37, height: 11, depth_or_array_layers: 1 };
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8Unorm,
            usage: wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let texels: Vec<u8> = (0..37 * 11 * 4_u32).map(|k| (k % 251) as u8).collect();
        let layout = TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(37 * 4),
            rows_per_image: Some(11),
        };
        gpu.queue.write_texture(texture.as_image_copy(), &texels, layout, size);
        for most_bytes in [1 << 20, 4 * 256, 256, 1] {
            assert!(read_in_bands(&gpu, &texture, most_bytes).unwrap() == texels, "{most_bytes}");
        }
    }
}
