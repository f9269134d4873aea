use corniche_roads::FunctionalRoadClass;
use wgpu::{Extent3d, Texture, TextureAspect, TextureFormat, TextureUsages, TextureView};

use super::{Gpu, GpuError};

pub(super) const COLOR: TextureFormat = TextureFormat::Rgba8Unorm;
pub(super) const DEPTH: TextureFormat = TextureFormat::Depth32Float;
pub(super) const LABEL: TextureFormat = TextureFormat::R8Uint;
pub(super) const OWNER: TextureFormat = TextureFormat::R32Uint;
/// Set in the owner of a pixel that shows a skirt.
const SKIRT_BIT: u32 = 1 << 31;

/// What the passes draw into; all of one size.
pub struct Targets {
    size_px: [u32; 2],
    ground: Texture,
    depth: Texture,
    owners: Texture,
    labels: Texture,
    picture: Texture,
}

/// Why pixels did not come back.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum ReadBackError {
    #[error("the graphics device did not finish drawing")]
    Poll { source: wgpu::PollError },
    #[error("the drawn pixels cannot be mapped")]
    Map { source: wgpu::BufferAsyncError },
    #[error("the drawn pixels cannot be read")]
    Range { source: wgpu::MapRangeError },
}

/// Whose a pixel of the terrain pass is; tiles by their place in the list that was drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Owner {
    /// No ground is seen.
    Nobody,
    /// A tile's ground.
    Ground(usize),
    /// A tile's skirt.
    Skirt(usize),
}

impl Owner {
    fn of(pixel: u32) -> Self {
        match (pixel & !SKIRT_BIT).checked_sub(1) {
            None => Self::Nobody,
            Some(tile) if pixel & SKIRT_BIT == 0 => Self::Ground(tile as usize),
            Some(tile) => Self::Skirt(tile as usize),
        }
    }
}

impl Targets {
    /// Targets of a size.
    ///
    /// # Errors
    /// When the size has a 0 or is beyond the adapter's limit.
    pub fn new(gpu: &Gpu, size_px: [u32; 2]) -> Result<Self, GpuError> {
        let limit_px = gpu.max_side_px();
        if size_px.contains(&0) {
            return Err(GpuError::Empty { size_px });
        }
        if size_px.iter().any(|side| *side > limit_px) {
            return Err(GpuError::TooLarge { size_px, limit_px });
        }
        let texture = |label, format| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
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
            })
        };
        Ok(Self {
            size_px,
            ground: texture("ground", COLOR),
            depth: texture("depth", DEPTH),
            owners: texture("owners", OWNER),
            labels: texture("road labels", LABEL),
            picture: texture("picture", COLOR),
        })
    }

    /// Width and height.
    #[must_use]
    pub fn size_px(&self) -> [u32; 2] {
        self.size_px
    }

    pub(super) fn ground_view(&self) -> TextureView {
        view(&self.ground)
    }

    pub(super) fn depth_view(&self) -> TextureView {
        view(&self.depth)
    }

    pub(super) fn owners_view(&self) -> TextureView {
        view(&self.owners)
    }

    pub(super) fn labels_view(&self) -> TextureView {
        view(&self.labels)
    }

    pub(super) fn picture_view(&self) -> TextureView {
        view(&self.picture)
    }

    /// The picture: four bytes a pixel (red, green, blue, 255), rows from the top.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn read_picture(&self, gpu: &Gpu) -> Result<Vec<u8>, ReadBackError> {
        self.read(gpu, &self.picture, 4)
    }

    /// What each pixel of the terrain pass is: four bytes a pixel, the last 255 for ground, 128 for skirt, 0 for
    /// nothing.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn read_ground(&self, gpu: &Gpu) -> Result<Vec<u8>, ReadBackError> {
        self.read(gpu, &self.ground, 4)
    }

    /// The terrain's depth buffer: near plane divided by view depth, 0 without ground.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn read_depth(&self, gpu: &Gpu) -> Result<Vec<f32>, ReadBackError> {
        let bytes = self.read(gpu, &self.depth, 4)?;
        Ok(bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect())
    }

    /// Whose each pixel of the terrain pass is.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn read_owners(&self, gpu: &Gpu) -> Result<Vec<Owner>, ReadBackError> {
        let bytes = self.read(gpu, &self.owners, 4)?;
        Ok(bytes
            .chunks_exact(4)
            .map(|b| Owner::of(u32::from_le_bytes([b[0], b[1], b[2], b[3]])))
            .collect())
    }

    /// The road label of each pixel; see [`label_class`].
    ///
    /// # Errors
    /// When the device is lost.
    pub fn read_labels(&self, gpu: &Gpu) -> Result<Vec<u8>, ReadBackError> {
        self.read(gpu, &self.labels, 1)
    }

    fn read(
        &self,
        gpu: &Gpu,
        texture: &Texture,
        bytes_per_pixel: u32,
    ) -> Result<Vec<u8>, ReadBackError> {
        let [width, height] = self.size_px;
        let row_bytes = width * bytes_per_pixel;
        let padded_bytes = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read back"),
            size: u64::from(padded_bytes) * u64::from(height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder =
            gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_texture_to_buffer(
            wgpu::TexelCopyTextureInfo { aspect: TextureAspect::All, ..texture.as_image_copy() },
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
        gpu.queue.submit([encoder.finish()]);
        let (sender, receiver) = std::sync::mpsc::channel();
        buffer.slice(..).map_async(wgpu::MapMode::Read, move |result| {
            // The receiver outlives the poll below, so sending cannot fail.
            let _ = sender.send(result);
        });
        gpu.device
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(|source| ReadBackError::Poll { source })?;
        if let Ok(Err(source)) = receiver.try_recv() {
            return Err(ReadBackError::Map { source });
        }
        let mapped = buffer
            .slice(..)
            .get_mapped_range()
            .map_err(|source| ReadBackError::Range { source })?;
        let mut rows = Vec::with_capacity((row_bytes * height) as usize);
        for row in mapped.chunks_exact(padded_bytes as usize) {
            rows.extend_from_slice(&row[..row_bytes as usize]);
        }
        Ok(rows)
    }
}

fn view(texture: &Texture) -> TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// The class a label stands for; `None` where there is no road.
#[must_use]
pub fn label_class(label: u8) -> Option<FunctionalRoadClass> {
    (label > 1)
        .then(|| (FunctionalRoadClass::COUNT as u8).checked_sub(label / 2))
        .flatten()
        .and_then(FunctionalRoadClass::new)
}
