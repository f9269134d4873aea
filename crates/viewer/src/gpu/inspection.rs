//! Reads back the layers of a drawing, sample by sample: tests compare them with references on the
//! CPU, and a legend lists the features of the picture. Other programs read the picture only.

use super::{Gpu, ReadBackError, drawables::depth_numbers::depth_numbers, targets::Targets};

/// This bit of a sample's owner is set for skirts and walls.
const SKIRT_BIT: u32 = 1 << 31;

/// This bit of a sample's owner is set for walls only.
const WALL_BIT: u32 = 1 << 30;

/// The tile that a sample of the terrain pass shows. Tiles are numbered by their position in the
/// list that was drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TileOwner {
    /// No tile: the sample shows no ground.
    Nobody,
    /// The ground of a tile.
    Ground(usize),
    /// The skirt of a tile.
    Skirt(usize),
    /// The wall of a tile along the edge of the data.
    Wall(usize),
}

impl TileOwner {
    fn from_pixel(pixel: u32) -> Self {
        match (pixel & !(SKIRT_BIT | WALL_BIT)).checked_sub(1) {
            None => Self::Nobody,
            Some(tile) if pixel & WALL_BIT != 0 => Self::Wall(tile as usize),
            Some(tile) if pixel & SKIRT_BIT == 0 => Self::Ground(tile as usize),
            Some(tile) => Self::Skirt(tile as usize),
        }
    }
}

/// Decodes owners from texels, four bytes each.
pub(crate) fn owners(texels: &[u8]) -> impl Iterator<Item = TileOwner> {
    texels
        .chunks_exact(4)
        .map(|b| TileOwner::from_pixel(u32::from_le_bytes([b[0], b[1], b[2], b[3]])))
}

impl Targets {
    /// Reads the colours of the terrain pass: four bytes per sample. The last byte is 255 for
    /// ground, 128 for a skirt, 0 where nothing was drawn.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub fn read_ground(&self, gpu: &Gpu) -> Result<Vec<u8>, ReadBackError> {
        self.ground.read(gpu)
    }

    /// Reads the terrain's depth buffer, sample by sample: near plane divided by view depth, 0
    /// without ground.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub fn read_depth(&self, gpu: &Gpu) -> Result<Vec<f32>, ReadBackError> {
        let bytes = depth_numbers(gpu, &self.depth).read(gpu)?;
        Ok(bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect())
    }

    /// Reads the tile that each sample of the terrain pass shows.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub fn read_owners(&self, gpu: &Gpu) -> Result<Vec<TileOwner>, ReadBackError> {
        let texels = self.owners.read(gpu)?;
        Ok(owners(&texels).collect())
    }

    /// Reads the deck label of each sample in the last drawing of decks; `None` if no decks have
    /// been drawn. 1 is a side, 2 an underside, others are labels of roads.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub fn read_deck_labels(&self, gpu: &Gpu) -> Result<Option<Vec<u8>>, ReadBackError> {
        self.drawn_decks().map(|decks| decks.labels.labels.read(gpu)).transpose()
    }

    /// Reads the road label of each sample, as defined in `gpu::labels`; 0 without a road.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub fn read_labels(&self, gpu: &Gpu) -> Result<Vec<u8>, ReadBackError> {
        self.roads.labels.read(gpu)
    }
}
