//! Pixels on their way back from the graphics card: of the map, or of the whole painted window.

use corniche_live::PixelReading;
use corniche_viewer::gpu::{Gpu, ReadBack, ReadBackError};
use image::RgbaImage;
use wgpu::{TextureFormat, TextureUsages};

/// A picture that is being taken.
pub(crate) struct Snapshot {
    pixels: PixelReading,
    has_blue_first: bool,
}

impl Snapshot {
    /// A picture of the map.
    pub(crate) fn of_map(pixels: PixelReading) -> Self {
        Self { pixels, has_blue_first: false }
    }

    /// Begins to read what is painted into a [`texture`].
    pub(crate) fn of_window(gpu: &Gpu, texture: &wgpu::Texture) -> Self {
        let (width, height) = (texture.width(), texture.height());
        let all = vec![(ReadBack::begin(gpu, texture), 0..width)];
        let has_blue_first =
            matches!(texture.format(), TextureFormat::Bgra8Unorm | TextureFormat::Bgra8UnormSrgb);
        Self { pixels: PixelReading::new(all, [width, height]), has_blue_first }
    }

    /// Whether all its pixels are there; never waits.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub(crate) fn has_arrived(&mut self, gpu: &Gpu) -> Result<bool, ReadBackError> {
        self.pixels.has_arrived(gpu)
    }

    /// The picture; waits for what is not yet there.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub(crate) fn into_image(self, gpu: &Gpu) -> Result<RgbaImage, ReadBackError> {
        let [width, height] = self.pixels.size_px();
        let mut bytes = self.pixels.into_pixels(gpu)?;
        let (pixels, _) = bytes.as_chunks_mut::<4>();
        for [a, _, b, opacity] in pixels {
            if self.has_blue_first {
                std::mem::swap(a, b);
            }
            // A window is opaque, whatever opacity its surface has.
            *opacity = 255;
        }
        // There are four bytes for each pixel, so this always succeeds.
        Ok(RgbaImage::from_raw(width, height, bytes).unwrap_or_default())
    }
}

/// A texture into which the window can be painted and from which it can be read.
pub(crate) fn texture(
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
