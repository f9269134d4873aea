//! Pixels on their way back from the graphics card: of the map, or of the whole painted window.

use corniche_viewer::gpu::{Gpu, Picture, ReadBack, ReadBackError};
use image::RgbaImage;
use wgpu::{TextureFormat, TextureUsages};

/// A picture that is being taken.
pub(crate) struct Snapshot {
    left: PictureTexels,
    /// The picture that is seen from a column on, and that column.
    right: Option<(PictureTexels, u32)>,
}

struct PictureTexels {
    size_px: [u32; 2],
    has_blue_first: bool,
    texels: ReadBack,
}

impl Snapshot {
    /// Begins to read one picture of the map, or two: the second is seen from `column` on.
    pub(crate) fn of_map(gpu: &Gpu, left: &Picture, right: Option<&Picture>, column: u32) -> Self {
        let part = |picture: &Picture| PictureTexels {
            size_px: picture.size_px(),
            has_blue_first: false,
            texels: picture.begin_read(gpu),
        };
        Self { left: part(left), right: right.map(|right| (part(right), column)) }
    }

    /// Begins to read what is painted into a [`texture`].
    pub(crate) fn of_window(gpu: &Gpu, texture: &wgpu::Texture) -> Self {
        let part = PictureTexels {
            size_px: [texture.width(), texture.height()],
            has_blue_first: matches!(
                texture.format(),
                TextureFormat::Bgra8Unorm | TextureFormat::Bgra8UnormSrgb
            ),
            texels: ReadBack::begin(gpu, texture),
        };
        Self { left: part, right: None }
    }

    /// Whether all its pixels are there; never waits.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub(crate) fn has_arrived(&mut self, gpu: &Gpu) -> Result<bool, ReadBackError> {
        let right = match &mut self.right {
            Some((part, _)) => part.texels.has_arrived(gpu)?,
            None => true,
        };
        Ok(self.left.texels.has_arrived(gpu)? && right)
    }

    /// The picture; waits for what is not yet there.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub(crate) fn into_image(self, gpu: &Gpu) -> Result<RgbaImage, ReadBackError> {
        let mut picture = self.left.into_image(gpu)?;
        if let Some((right, column)) = self.right {
            let right = right.into_image(gpu)?;
            for (x, y, pixel) in picture.enumerate_pixels_mut() {
                if x >= column {
                    *pixel = *right.get_pixel(x, y);
                }
            }
        }
        Ok(picture)
    }
}

impl PictureTexels {
    fn into_image(self, gpu: &Gpu) -> Result<RgbaImage, ReadBackError> {
        let mut bytes = self.texels.into_texels(gpu)?;
        let (pixels, _) = bytes.as_chunks_mut::<4>();
        for [a, _, b, opacity] in pixels {
            if self.has_blue_first {
                std::mem::swap(a, b);
            }
            // A window is opaque, whatever opacity its surface has.
            *opacity = 255;
        }
        let [width, height] = self.size_px;
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
