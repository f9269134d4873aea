//! The photos of a build are opened and placed on the grid, or taken from another package.

use crate::terrain::ground::GroundSource;
use corniche_dem::GridPlan;
use corniche_gis::{FileBlocks, FileDatums};
use corniche_photo::{LevelChoice, PhotoGrid, Photos};
use corniche_spec::{PhotoChoice, PhotoSettings};
use corniche_tileset::PhotoRecord;

use crate::GroundError;

/// Where the photos of a build come from.
pub enum PhotoSource {
    /// There are none.
    Nothing,
    /// Photos of files.
    Files(Box<OpenedPhotos>),
    /// Photos come from the package that gives the terrain, as they are there. It says how they were made.
    Package(PhotoRecord),
}

impl PhotoSource {
    /// Opens the photos that a build asks for, on the grid of its ground.
    ///
    /// # Errors
    /// See [`GroundError`].
    pub fn open(
        choice: &PhotoChoice,
        allow_ballpark: bool,
        source: &GroundSource,
        grid: &GridPlan,
    ) -> Result<Self, GroundError> {
        match choice {
            PhotoChoice::Off => Ok(Self::Nothing),
            PhotoChoice::OfTerrain => {
                let recorded =
                    source.package().and_then(|package| package.manifest().settings.photo);
                Ok(recorded.map_or(Self::Nothing, Self::Package))
            }
            PhotoChoice::Files(settings) => {
                Ok(Self::Files(Box::new(OpenedPhotos::open(settings, allow_ballpark, grid)?)))
            }
        }
    }

    /// The photos that are read from files.
    #[must_use]
    pub fn files(&self) -> Option<&OpenedPhotos> {
        match self {
            Self::Nothing | Self::Package(_) => None,
            Self::Files(photos) => Some(photos),
        }
    }

    /// What the manifest says of how photos are made; `None` without photos.
    #[must_use]
    pub fn record(&self) -> Option<PhotoRecord> {
        match self {
            Self::Nothing => None,
            Self::Files(photos) => Some(photos.record()),
            Self::Package(record) => Some(*record),
        }
    }
}

/// Photos, opened and put on the grid.
pub struct OpenedPhotos {
    /// The grid of texels.
    pub grid: PhotoGrid,
    /// JPEG's quality, from 1 to 100.
    pub quality: u8,
    /// What the files say of their rights.
    pub credits: Vec<String>,
    /// How the files are cut into blocks.
    pub blocks: Vec<FileBlocks>,
    /// How they come to the datum of the grid.
    pub datums: FileDatums,
}

impl OpenedPhotos {
    fn open(
        settings: &PhotoSettings,
        allow_ballpark: bool,
        grid: &GridPlan,
    ) -> Result<Self, GroundError> {
        let photos = Photos::open(&settings.files)?;
        let datums = grid.datums_of_rasters(photos.rasters()).allowed(allow_ballpark)?;
        let levels = settings.levels.map_or(LevelChoice::OfPhotos, LevelChoice::Given);
        Ok(Self {
            grid: photos.on(grid, levels)?,
            quality: settings.quality,
            credits: photos
                .credits()
                .iter()
                .map(|text| corniche_tileset::to_credit(text))
                .collect(),
            blocks: photos.file_blocks()?,
            datums,
        })
    }

    /// What the manifest says of how they are made.
    #[must_use]
    pub fn record(&self) -> PhotoRecord {
        PhotoRecord { levels: self.levels(), quality: self.quality }
    }

    /// How many levels of texels are finer than the finest cell.
    #[must_use]
    pub fn levels(&self) -> u8 {
        self.grid.texels().levels()
    }
}
