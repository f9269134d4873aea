use corniche_dem::{FileBlocks, GridPlan};
use corniche_photo::{LevelChoice, PhotoGrid, Photos};
use corniche_tileset::PhotoRecord;

use crate::{BuildError, PhotoSettings};

/// Photos, opened and put on the grid.
pub(crate) struct OpenedPhotos {
    pub(crate) grid: PhotoGrid,
    pub(crate) quality: u8,
    /// What the files say of their rights.
    pub(crate) credits: Vec<String>,
    /// How the files are cut into blocks.
    pub(crate) blocks: Vec<FileBlocks>,
}

impl OpenedPhotos {
    pub(crate) fn open(settings: &PhotoSettings, grid: &GridPlan) -> Result<Self, BuildError> {
        let photos = Photos::open(&settings.files)?;
        let levels = settings.levels.map_or(LevelChoice::OfPhotos, LevelChoice::Given);
        Ok(Self {
            grid: photos.on(grid, levels)?,
            quality: settings.quality,
            credits: photos.credits(),
            blocks: photos.file_blocks()?,
        })
    }

    /// What the manifest says of how they are made.
    pub(crate) fn record(&self) -> PhotoRecord {
        PhotoRecord { levels: self.levels(), quality: self.quality }
    }

    /// How many levels of texels are finer than the finest cell.
    pub(crate) fn levels(&self) -> u8 {
        self.grid.texels().levels()
    }
}
