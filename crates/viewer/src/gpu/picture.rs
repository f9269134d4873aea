use wgpu::{Extent3d, TextureFormat, TextureUsages, TextureView};

use super::{Gpu, GpuError, ReadBack, ReadBackError, read_texture};

pub(crate) const COLOR: TextureFormat = TextureFormat::Rgba8Unorm;

/// Samples on each side of a pixel, at most. Sums of so many colours stay exact, and sixteen are more than one sees.
pub const MAX_SAMPLES_PER_SIDE: u32 = 4;

/// What is shown: a texture that holds colours as sRGB encodes them, without being of an sRGB format.
///
/// With several samples a pixel there is a second, larger texture that is drawn first and averaged into it.
pub struct Picture {
    size_px: [u32; 2],
    samples_per_side: u32,
    samples: Option<Plane>,
    pixels: Plane,
}

/// A texture and its only view.
pub(crate) struct Plane {
    texture: wgpu::Texture,
    pub(crate) view: TextureView,
}

impl Picture {
    /// A picture with this width and height and as many samples on each side of a pixel.
    ///
    /// # Errors
    /// When the size has a 0, is beyond the adapter's limit with its samples, or they are too many or none.
    pub fn new(gpu: &Gpu, size_px: [u32; 2], samples_per_side: u32) -> Result<Self, GpuError> {
        let sampled_px = sampled_px(gpu, size_px, samples_per_side)?;
        let samples = (samples_per_side > 1).then(|| Plane::new(gpu, "samples", COLOR, sampled_px));
        let pixels = Plane::new(gpu, "picture", COLOR, size_px);
        Ok(Self { size_px, samples_per_side, samples, pixels })
    }

    /// Width and height in pixels.
    #[must_use]
    pub fn size_px(&self) -> [u32; 2] {
        self.size_px
    }

    /// Samples on each side of a pixel.
    #[must_use]
    pub fn samples_per_side(&self) -> u32 {
        self.samples_per_side
    }

    /// To bind it, in a window for instance.
    #[must_use]
    pub fn view(&self) -> &TextureView {
        &self.pixels.view
    }

    /// Four bytes a pixel (red, green, blue, 255), rows from the top.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub fn read(&self, gpu: &Gpu) -> Result<Vec<u8>, ReadBackError> {
        self.pixels.read(gpu)
    }

    /// The same as an image.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub fn read_image(&self, gpu: &Gpu) -> Result<image::RgbaImage, ReadBackError> {
        let [width, height] = self.size_px;
        // Four bytes for each pixel, so there is always an image.
        Ok(image::RgbaImage::from_raw(width, height, self.read(gpu)?).unwrap_or_default())
    }

    /// Asks for the bytes of [`Picture::read`] without waiting for them.
    #[must_use]
    pub fn begin_read(&self, gpu: &Gpu) -> ReadBack {
        ReadBack::begin(gpu, &self.pixels.texture)
    }

    /// What is drawn into: the samples, or the pixels where there is one sample each.
    pub(crate) fn drawn(&self) -> &TextureView {
        self.samples.as_ref().map_or(&self.pixels.view, |samples| &samples.view)
    }

    /// The samples, where there are several a pixel.
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

impl Plane {
    pub(crate) fn new(gpu: &Gpu, label: &str, format: TextureFormat, size_px: [u32; 2]) -> Self {
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
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
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Self { texture, view }
    }

    /// Its texels, row by row from the top.
    pub(crate) fn read(&self, gpu: &Gpu) -> Result<Vec<u8>, ReadBackError> {
        read_texture(gpu, &self.texture)
    }
}
