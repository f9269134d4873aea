//! What each sample of a drawing is made of, read back: tests compare it with references on the processor, and a legend lists what it shows. Else
//! programs read the picture only.

use super::{Gpu, ReadBackError, drawables::depth_numbers::depth_numbers, targets::Targets};

/// This bit of the owner of a sample is set if the sample shows a skirt or a wall.
const SKIRT_BIT: u32 = 1 << 31;

/// This bit is set on walls alone.
const WALL_BIT: u32 = 1 << 30;

/// Which tile a sample of the terrain pass shows. Tiles are numbered by their place in the list that was drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Owner {
    /// None: the sample shows no ground.
    Nobody,
    /// A tile's ground.
    Ground(usize),
    /// A tile's skirt.
    Skirt(usize),
    /// The wall along the edge of the data, of a tile.
    Wall(usize),
}

impl Owner {
    fn of(pixel: u32) -> Self {
        match (pixel & !(SKIRT_BIT | WALL_BIT)).checked_sub(1) {
            None => Self::Nobody,
            Some(tile) if pixel & WALL_BIT != 0 => Self::Wall(tile as usize),
            Some(tile) if pixel & SKIRT_BIT == 0 => Self::Ground(tile as usize),
            Some(tile) => Self::Skirt(tile as usize),
        }
    }
}

/// The owners that texels tell, four bytes each.
pub(crate) fn owners(texels: &[u8]) -> impl Iterator<Item = Owner> {
    texels.chunks_exact(4).map(|b| Owner::of(u32::from_le_bytes([b[0], b[1], b[2], b[3]])))
}

impl Targets {
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
        let bytes = depth_numbers(gpu, &self.depth).read(gpu)?;
        Ok(bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect())
    }

    /// Which tile each sample of the terrain pass shows.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub fn read_owners(&self, gpu: &Gpu) -> Result<Vec<Owner>, ReadBackError> {
        let texels = self.owners.read(gpu)?;
        Ok(owners(&texels).collect())
    }

    /// The label of the deck of each sample, as decks were drawn last; `None` if none ever were. 1 is a side, 2 an underside, others are labels of roads.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub fn read_deck_labels(&self, gpu: &Gpu) -> Result<Option<Vec<u8>>, ReadBackError> {
        self.drawn_decks().map(|decks| decks.labels.labels.read(gpu)).transpose()
    }

    /// The road label of each sample, as `gpu::labels` draws them; 0 without a road.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub fn read_labels(&self, gpu: &Gpu) -> Result<Vec<u8>, ReadBackError> {
        self.roads.labels.read(gpu)
    }
}
