//! The picture on the GPU into which passes draw, with its samples per pixel.

use wgpu::TextureView;

use super::{
    Gpu, GpuError, ReadBack, ReadBackError, formats::COLOR, target_texture::TargetTexture,
};

/// Maximum number of samples on each side of a pixel. Sums of this many colours are exact, and with
/// more than sixteen samples per pixel the eye sees no difference.
pub const MAX_SAMPLES_PER_SIDE: u32 = 4;

/// The final picture: a texture of colours, encoded as sRGB. Its format is not an sRGB format, so
/// that no colour is converted.
///
/// With several samples per pixel there is a second, larger texture: samples are drawn there and
/// averaged into the picture.
pub struct Picture {
    /// Width and height in pixels.
    pub size_px: [u32; 2],
    /// Samples on each side of a pixel.
    pub samples_per_side: u32,
    samples: Option<TargetTexture>,
    pixels: TargetTexture,
}

impl Picture {
    /// Creates a picture with this width and height and this many samples on each side of a pixel.
    ///
    /// # Errors
    /// When the size has a 0, when it has more samples than the adapter can draw, or when there are
    /// no samples or too many per pixel.
    pub fn new(gpu: &Gpu, size_px: [u32; 2], samples_per_side: u32) -> Result<Self, GpuError> {
        let sampled_px = sampled_px(gpu, size_px, samples_per_side)?;
        let samples =
            (samples_per_side > 1).then(|| TargetTexture::new(gpu, "samples", COLOR, sampled_px));
        let pixels = TargetTexture::new(gpu, "picture", COLOR, size_px);
        Ok(Self { size_px, samples_per_side, samples, pixels })
    }

    /// The view of the picture for binding, for instance in a window.
    #[must_use]
    pub fn view(&self) -> &TextureView {
        &self.pixels.view
    }

    /// Reads four bytes per pixel (red, green, blue, 255), rows from the top.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub fn read(&self, gpu: &Gpu) -> Result<Vec<u8>, ReadBackError> {
        self.pixels.read(gpu)
    }

    /// Reads the bytes of [`Picture::read`] as an image.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    #[cfg(feature = "annotations")]
    pub fn read_image(&self, gpu: &Gpu) -> Result<image::RgbaImage, ReadBackError> {
        let [width, height] = self.size_px;
        // There are four bytes per pixel, so this is always an image.
        Ok(image::RgbaImage::from_raw(width, height, self.read(gpu)?).unwrap_or_default())
    }

    /// Requests the bytes of [`Picture::read`] without waiting for them.
    #[must_use]
    pub fn begin_read(&self, gpu: &Gpu) -> ReadBack {
        ReadBack::begin(gpu, &self.pixels.texture)
    }

    /// The texture into which passes draw: the samples, or the pixels themselves if each has one
    /// sample.
    pub(crate) fn drawn(&self) -> &TextureView {
        self.samples.as_ref().map_or(&self.pixels.view, |samples| &samples.view)
    }

    /// The samples, if there are several per pixel.
    pub(crate) fn samples(&self) -> Option<&TextureView> {
        self.samples.as_ref().map(|samples| &samples.view)
    }

    /// Width and height in samples.
    pub(crate) fn sampled_px(&self) -> [u32; 2] {
        self.size_px.map(|side| side * self.samples_per_side)
    }
}

/// Width and height in samples, if the adapter can draw them.
fn sampled_px(gpu: &Gpu, size_px: [u32; 2], samples_per_side: u32) -> Result<[u32; 2], GpuError> {
    let limit_px = gpu.max_side_px();
    if size_px.contains(&0) {
        return Err(GpuError::Empty { size_px });
    }
    if !(1..=MAX_SAMPLES_PER_SIDE).contains(&samples_per_side) {
        return Err(GpuError::Samples { samples_per_side, most: MAX_SAMPLES_PER_SIDE });
    }
    if size_px.iter().any(|side| *side > limit_px / samples_per_side) {
        return Err(GpuError::TooLarge { size_px, samples_per_side, limit_px });
    }
    Ok(size_px.map(|side| side * samples_per_side))
}
