use corniche_roads::FunctionalRoadClass;
use wgpu::TextureFormat;

use super::{
    Gpu, GpuError, ReadBackError,
    picture::{COLOR, Picture, Plane},
};

pub(crate) const DEPTH: TextureFormat = TextureFormat::Depth32Float;
pub(crate) const LABEL: TextureFormat = TextureFormat::R8Unorm;
pub(crate) const OWNER: TextureFormat = TextureFormat::R32Uint;
/// Samples on each side of a block. Smaller ones lie closer around roads, larger ones are fewer to ask for: on software
/// Vulkan 8, 16 and 32 cost the same within its noise.
pub(crate) const BLOCK: u32 = 16;
/// Set in the owner of a sample that shows a skirt.
const SKIRT_BIT: u32 = 1 << 31;

/// What the passes draw into: a picture and, sample for sample, what it is made of.
pub struct Targets {
    pub(crate) ground: Plane,
    pub(crate) depth: Plane,
    pub(crate) owners: Plane,
    pub(crate) labels: Plane,
    /// The largest label in or near each block of samples.
    pub(crate) road_blocks: Plane,
    picture: Picture,
}

/// Whose a sample of the terrain pass is; tiles by their place in the list that was drawn.
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
    /// Targets for a picture of this size, with so many samples on each side of a pixel; 1 takes the pixel's centre
    /// alone. Everything but the picture itself is as large as there are samples: 17 bytes each, and one for each block
    /// of 16 × 16.
    ///
    /// # Errors
    /// When the size has a 0, is beyond the adapter's limit with its samples, or they are too many or none.
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

    /// To bind the picture, in a window for instance.
    #[must_use]
    pub fn picture_view(&self) -> &wgpu::TextureView {
        self.picture.view()
    }

    /// How many blocks its samples are cut into; those on the right and at the bottom may reach beyond them.
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

    /// What each sample of the terrain pass is: four bytes a sample, the last 255 for ground, 128 for skirt, 0 for
    /// nothing.
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

    /// Whose each sample of the terrain pass is.
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

/// The class a label stands for; `None` where there is no road.
#[must_use]
pub fn label_class(label: u8) -> Option<FunctionalRoadClass> {
    (label > 1)
        .then(|| (FunctionalRoadClass::COUNT as u8).checked_sub(label / 2))
        .flatten()
        .and_then(FunctionalRoadClass::new)
}
