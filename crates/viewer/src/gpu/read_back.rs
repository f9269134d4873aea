use std::sync::mpsc::{self, Receiver};

use wgpu::{BufferAsyncError, BufferUsages, Origin3d, TexelCopyBufferInfo, TexelCopyBufferLayout};

use super::{Gpu, ReadBackError};

/// Texels of a texture, row by row from the top, without gaps. Waits until it is drawn.
///
/// The texture can be copied from, and its format has one plane of whole texels.
///
/// # Errors
/// When the device is lost or could not draw.
pub fn read_texture(gpu: &Gpu, texture: &wgpu::Texture) -> Result<Vec<u8>, ReadBackError> {
    ReadBack::begin(gpu, texture).into_texels(gpu)
}

/// Texels of a texture on their way back, as they are when all is drawn that was handed over before.
pub struct ReadBack {
    row_bytes: usize,
    padded_bytes: usize,
    bands: Vec<Band>,
    /// So many of the bands are there.
    arrived: usize,
}

/// Some rows of a texture: the largest are larger than a buffer may be.
struct Band {
    buffer: wgpu::Buffer,
    mapped: Receiver<Result<(), BufferAsyncError>>,
}

impl ReadBack {
    /// Asks for a texture; see [`read_texture`].
    #[must_use]
    pub fn begin(gpu: &Gpu, texture: &wgpu::Texture) -> Self {
        Self::by_bands(gpu, texture, gpu.device.limits().max_buffer_size)
    }

    /// The same by bands of rows that take no more than `most_bytes` each, though always a row.
    fn by_bands(gpu: &Gpu, texture: &wgpu::Texture, most_bytes: u64) -> Self {
        let (width, height) = (texture.width(), texture.height());
        let row_bytes = width * texture.format().block_copy_size(None).unwrap_or(4);
        let padded_bytes = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        // No more than the texture's height, which is a u32.
        let band_rows =
            (most_bytes / u64::from(padded_bytes)).clamp(1, u64::from(height.max(1))) as u32;
        let bands = (0..height)
            .step_by(band_rows as usize)
            .map(|top| Band::ask(gpu, texture, top, band_rows.min(height - top), padded_bytes))
            .collect();
        Self {
            row_bytes: row_bytes as usize,
            padded_bytes: padded_bytes as usize,
            bands,
            arrived: 0,
        }
    }

    /// Whether all of it is there; never waits.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub fn has_arrived(&mut self, gpu: &Gpu) -> Result<bool, ReadBackError> {
        gpu.device.poll(wgpu::PollType::Poll).map_err(|source| ReadBackError::Poll { source })?;
        gpu.check()?;
        while let Some(band) = self.bands.get(self.arrived) {
            match band.mapped.try_recv() {
                Ok(Ok(())) => self.arrived += 1,
                Ok(Err(source)) => return Err(ReadBackError::Map { source }),
                Err(_) => return Ok(false),
            }
        }
        Ok(true)
    }

    /// The texels; waits for what is not yet there.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub fn into_texels(mut self, gpu: &Gpu) -> Result<Vec<u8>, ReadBackError> {
        if self.arrived < self.bands.len() {
            gpu.finish()?;
            self.has_arrived(gpu)?;
        }
        let mut texels = Vec::new();
        for band in &self.bands {
            let mapped = band
                .buffer
                .slice(..)
                .get_mapped_range()
                .map_err(|source| ReadBackError::Range { source })?;
            for row in mapped.chunks_exact(self.padded_bytes) {
                texels.extend_from_slice(&row[..self.row_bytes]);
            }
        }
        Ok(texels)
    }
}

impl Band {
    fn ask(gpu: &Gpu, texture: &wgpu::Texture, top: u32, rows: u32, padded_bytes: u32) -> Self {
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read back"),
            size: u64::from(padded_bytes) * u64::from(rows),
            usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
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
                    rows_per_image: Some(rows),
                },
            },
            wgpu::Extent3d { width: texture.width(), height: rows, depth_or_array_layers: 1 },
        );
        gpu.queue.submit([encoder.finish()]);
        let (sender, mapped) = mpsc::channel();
        buffer.slice(..).map_async(wgpu::MapMode::Read, move |result| {
            // Nobody waits for it any more, then.
            let _ = sender.send(result);
        });
        Self { buffer, mapped }
    }
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

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
            let waiting = ReadBack::by_bands(&gpu, &texture, most_bytes);
            assert!(waiting.into_texels(&gpu).unwrap() == texels, "{most_bytes}");

            let mut asking = ReadBack::by_bands(&gpu, &texture, most_bytes);
            let begun = Instant::now();
            while !asking.has_arrived(&gpu).unwrap() {
                assert!(begun.elapsed() < Duration::from_mins(1), "{most_bytes}");
            }
            assert!(asking.has_arrived(&gpu).unwrap(), "and stays there");
            assert!(asking.into_texels(&gpu).unwrap() == texels, "{most_bytes}");
        }
        let lost = ReadBack::begin(&gpu, &texture);
        gpu.device.destroy();
        assert!(lost.into_texels(&gpu).is_err());
    }
}
