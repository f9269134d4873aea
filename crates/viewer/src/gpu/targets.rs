use super::{
    Gpu, GpuError, ReadBackError,
    formats::{BLOCK, COLOR, DEPTH, LABEL, OWNER},
    picture::Picture,
    plane::Plane,
};

/// This bit of the owner of a sample is set if the sample shows a skirt.
const SKIRT_BIT: u32 = 1 << 31;

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

/// Which tile a sample of the terrain pass shows. Tiles are numbered by their place in the list that was drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Owner {
    /// None: the sample shows no ground.
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

    /// A view of the picture to bind, for instance in a window.
    #[must_use]
    pub fn picture_view(&self) -> &wgpu::TextureView {
        self.picture.view()
    }

    /// How many blocks its samples are divided into. Blocks on the right and at the bottom may reach beyond the samples.
    pub(crate) fn block_count(&self) -> u32 {
        self.picture.sampled_px().map(|side| side.div_ceil(BLOCK)).iter().product()
    }

    /// The picture: four bytes a pixel (red, green, blue, 255), rows from the top.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub fn read_picture(&self, gpu: &Gpu) -> Result<Vec<u8>, ReadBackError> {
        self.picture.read(gpu)
    }

    /// The colours of the terrain pass: four bytes a sample. The last is 255 for ground, 128 for a skirt, 0 where nothing
    /// was drawn.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub fn read_ground(&self, gpu: &Gpu) -> Result<Vec<u8>, ReadBackError> {
        self.ground.read(gpu)
    }

    /// The terrain's depth buffer, sample by sample: near plane divided by view depth, 0 without ground.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub fn read_depth(&self, gpu: &Gpu) -> Result<Vec<f32>, ReadBackError> {
        let bytes = self.depth.read(gpu)?;
        Ok(bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect())
    }

    /// Which tile each sample of the terrain pass shows.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub fn read_owners(&self, gpu: &Gpu) -> Result<Vec<Owner>, ReadBackError> {
        let bytes = self.owners.read(gpu)?;
        Ok(bytes
            .chunks_exact(4)
            .map(|b| Owner::of(u32::from_le_bytes([b[0], b[1], b[2], b[3]])))
            .collect())
    }

    /// The road label of each sample; see [`label_class`].
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub fn read_labels(&self, gpu: &Gpu) -> Result<Vec<u8>, ReadBackError> {
        self.labels.read(gpu)
    }
}
