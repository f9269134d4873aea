//! Pixels being read back from the GPU: of the map, or of the whole painted window.

use corniche_live::PixelReading;
use corniche_viewer::gpu::{Gpu, ReadBackError};
use image::RgbaImage;

/// An image that is being taken.
pub(crate) struct Snapshot {
    pub(crate) pixels: PixelReading,
    pub(crate) has_blue_first: bool,
}

impl Snapshot {
    /// The image; waits for pixels that have not arrived yet.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub(crate) fn into_image(self, gpu: &Gpu) -> Result<RgbaImage, ReadBackError> {
        let [width, height] = self.pixels.size_px;
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
