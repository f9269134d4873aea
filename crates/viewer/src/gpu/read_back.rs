//! Reads textures back from the GPU, in bands if they are large.

use std::sync::mpsc::{self, Receiver, TryRecvError};

use wgpu::{BufferAsyncError, BufferUsages, Origin3d, TexelCopyBufferInfo, TexelCopyBufferLayout};

use super::{Gpu, ReadBackError};

/// Reads the texels of a texture, row by row from the top, without gaps. Waits until the texture is
/// drawn.
///
/// The texture must allow copies, and its format must have one plane of whole texels.
///
/// # Errors
/// When the device is lost or could not draw.
pub(crate) fn read_texture(gpu: &Gpu, texture: &wgpu::Texture) -> Result<Vec<u8>, ReadBackError> {
    read_by_bands(gpu, texture, gpu.device.limits().max_buffer_size)
}

/// Does the same as [`read_texture`] in bands of rows. A band has at most `most_bytes`, but at
/// least one row: the largest pictures exceed the maximum size of a buffer. Bands are read one
/// after another, so that there is one buffer at a time.
fn read_by_bands(
    gpu: &Gpu,
    texture: &wgpu::Texture,
    most_bytes: u64,
) -> Result<Vec<u8>, ReadBackError> {
    let layout = Layout::new(texture, most_bytes);
    let mut texels = Vec::with_capacity(layout.bytes());
    for rows in layout.bands() {
        let mut band = Band::ask(gpu, texture, &layout, rows);
        gpu.finish()?;
        if !band.has_arrived()? {
            return Err(ReadBackError::Missing);
        }
        band.append_to(&mut texels, &layout)?;
    }
    Ok(texels)
}

/// The texels of a texture after all previously submitted commands; they are being read back.
pub struct ReadBack {
    layout: Layout,
    bands: Vec<Band>,
}

impl ReadBack {
    /// Requests all texels of a texture. The texture must allow copies, and its format must have
    /// one plane of whole texels.
    #[must_use]
    pub fn begin(gpu: &Gpu, texture: &wgpu::Texture) -> Self {
        Self::by_bands(gpu, texture, gpu.device.limits().max_buffer_size)
    }

    fn by_bands(gpu: &Gpu, texture: &wgpu::Texture, most_bytes: u64) -> Self {
        let layout = Layout::new(texture, most_bytes);
        let bands = layout.bands().map(|rows| Band::ask(gpu, texture, &layout, rows)).collect();
        Self { layout, bands }
    }

    /// Whether all texels have arrived; never waits.
    ///
    /// # Errors
    /// When the device is lost, or it had a fault since the last check.
    pub fn has_arrived(&mut self, gpu: &Gpu) -> Result<bool, ReadBackError> {
        gpu.device.poll(wgpu::PollType::Poll).map_err(|source| ReadBackError::Poll { source })?;
        gpu.check()?;
        for band in &mut self.bands {
            if !band.has_arrived()? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Returns the texels; waits for those that have not arrived.
    ///
    /// # Errors
    /// Same as [`ReadBack::has_arrived`].
    pub fn into_texels(mut self, gpu: &Gpu) -> Result<Vec<u8>, ReadBackError> {
        if !self.has_arrived(gpu)? {
            gpu.finish()?;
            if !self.has_arrived(gpu)? {
                return Err(ReadBackError::Missing);
            }
        }
        let mut texels = Vec::with_capacity(self.layout.bytes());
        for band in self.bands {
            band.append_to(&mut texels, &self.layout)?;
        }
        Ok(texels)
    }
}

/// The layout of a texture's rows in buffers.
struct Layout {
    width: u32,
    height: u32,
    row_bytes: u32,
    padded_bytes: u32,
    band_rows: u32,
}

impl Layout {
    fn new(texture: &wgpu::Texture, most_bytes: u64) -> Self {
        let (width, height) = (texture.width(), texture.height());
        let row_bytes = width * texture.format().block_copy_size(None).unwrap_or(4);
        let padded_bytes = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        // At most the texture's height, which is a u32.
        let band_rows = (most_bytes / u64::from(padded_bytes)).clamp(1, u64::from(height)) as u32;
        Self { width, height, row_bytes, padded_bytes, band_rows }
    }

    /// Bytes of all texels, without the padding of rows.
    fn bytes(&self) -> usize {
        self.row_bytes as usize * self.height as usize
    }

    /// The first row of each band and its number of rows.
    fn bands(&self) -> impl Iterator<Item = [u32; 2]> + use<> {
        let (height, band_rows) = (self.height, self.band_rows);
        (0..height).step_by(band_rows as usize).map(move |top| [top, band_rows.min(height - top)])
    }
}

/// A band of rows of a texture in a buffer that can be mapped.
struct Band {
    buffer: wgpu::Buffer,
    mapped: Receiver<Result<(), BufferAsyncError>>,
    is_mapped: bool,
}

impl Band {
    fn ask(gpu: &Gpu, texture: &wgpu::Texture, layout: &Layout, [top, rows]: [u32; 2]) -> Self {
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read back"),
            size: u64::from(layout.padded_bytes) * u64::from(rows),
            usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let origin = Origin3d { x: 0, y: top, z: 0 };
        let from = wgpu::TexelCopyTextureInfo { origin, ..texture.as_image_copy() };
        let in_buffer = TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(layout.padded_bytes),
            rows_per_image: Some(rows),
        };
        let size = wgpu::Extent3d { width: layout.width, height: rows, depth_or_array_layers: 1 };
        gpu.submit("read back", |encoder| {
            let into = TexelCopyBufferInfo { buffer: &buffer, layout: in_buffer };
            encoder.copy_texture_to_buffer(from, into, size);
        });
        let (sender, mapped) = mpsc::channel();
        buffer.slice(..).map_async(wgpu::MapMode::Read, move |result| {
            // Sending fails if the band was dropped; then nobody needs the result.
            let _ = sender.send(result);
        });
        Self { buffer, mapped, is_mapped: false }
    }

    fn has_arrived(&mut self) -> Result<bool, ReadBackError> {
        if !self.is_mapped {
            match self.mapped.try_recv() {
                Ok(Ok(())) => self.is_mapped = true,
                Ok(Err(source)) => return Err(ReadBackError::Map { source }),
                Err(TryRecvError::Empty) => {}
                Err(TryRecvError::Disconnected) => return Err(ReadBackError::Missing),
            }
        }
        Ok(self.is_mapped)
    }

    /// Appends the rows of the band, which must have arrived.
    fn append_to(self, texels: &mut Vec<u8>, layout: &Layout) -> Result<(), ReadBackError> {
        let mapped = self
            .buffer
            .slice(..)
            .get_mapped_range()
            .map_err(|source| ReadBackError::Range { source })?;
        for row in mapped.chunks_exact(layout.padded_bytes as usize) {
            texels.extend_from_slice(&row[..layout.row_bytes as usize]);
        }
        Ok(())
    }
}

#[cfg(test)]
#[path = "read_back_tests.rs"]
mod tests;
