use super::{
    Gpu, GpuError,
    formats::{BLOCK, COLOR, DEPTH, LABEL, OWNER},
    picture::Picture,
    plane::Plane,
};

/// The textures that the passes draw into: a picture and, sample by sample, what it is made of.
pub struct Targets {
    pub(crate) ground: Plane,
    pub(crate) depth: Plane,
    pub(crate) owners: Plane,
    pub(crate) labels: Plane,
    /// The largest label in or near each block of samples; see [`BLOCK`].
    pub(crate) road_blocks: Plane,
    picture: Picture,
}

impl Targets {
    /// Targets for a picture of this size, with so many samples on each side of a pixel; 1 takes the pixel's centre
    /// alone. Besides the picture they take 17 bytes for each sample, and one byte for each block of 16 × 16 samples.
    ///
    /// # Errors
    /// When the size has a 0, when its samples are more than the adapter can draw, or when there are no samples or too many
    /// a pixel.
    pub fn new(gpu: &Gpu, size_px: [u32; 2], samples_per_side: u32) -> Result<Self, GpuError> {
        let picture = Picture::new(gpu, size_px, samples_per_side)?;
        let sampled_px = picture.sampled_px();
        let plane = |label, format| Plane::new(gpu, label, format, sampled_px);
        let blocks = sampled_px.map(|side| side.div_ceil(BLOCK));
        Ok(Self {
            ground: plane("ground", COLOR),
            depth: plane("depth", DEPTH),
            owners: plane("owners", OWNER),
            labels: plane("road labels", LABEL),
            road_blocks: Plane::new(gpu, "road blocks", LABEL, blocks),
            picture,
        })
    }

    /// The picture.
    #[must_use]
    pub fn picture(&self) -> &Picture {
        &self.picture
    }

    /// Width and height of the picture.
    #[must_use]
    pub fn size_px(&self) -> [u32; 2] {
        self.picture.size_px()
    }

    /// Samples on each side of one of its pixels.
    #[must_use]
    pub fn samples_per_side(&self) -> u32 {
        self.picture.samples_per_side()
    }

    /// How many blocks its samples are divided into. Blocks on the right and at the bottom may reach beyond the samples.
    pub(crate) fn block_count(&self) -> u32 {
        self.picture.sampled_px().map(|side| side.div_ceil(BLOCK)).iter().product()
    }
}
