//! Opens the photos of a build and places them on the grid, or takes them from another package.

use crate::terrain::ground::GroundSource;
use corniche_dem::GridPlan;
use corniche_gis::{FileBlocks, FileDatums};
use corniche_photo::{LevelChoice, PhotoGrid, Photos};
use corniche_spec::{PhotoChoice, PhotoSettings};
use corniche_tileset::PhotoRecord;

use crate::GroundError;

/// The source of a build's photos.
pub enum PhotoSource {
    /// The build has no photos.
    Nothing,
    /// Photos come from files.
    Files(Box<OpenedPhotos>),
    /// Photos come unchanged from the package that provides the terrain. The record describes how
    /// they were created.
    Package(PhotoRecord),
}

impl PhotoSource {
    /// Opens the requested photos of a build on the grid of its ground.
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

    /// The manifest's record of how photos are created; `None` without photos.
    #[must_use]
    pub fn record(&self) -> Option<PhotoRecord> {
        match self {
            Self::Nothing => None,
            Self::Files(photos) => Some(photos.record()),
            Self::Package(record) => Some(*record),
        }
    }
}

/// Photos that are open and placed on the grid.
pub struct OpenedPhotos {
    /// The grid of texels.
    pub grid: PhotoGrid,
    /// JPEG's quality, from 1 to 100.
    pub quality: u8,
    /// Attribution found in the files.
    pub credits: Vec<String>,
    /// How the files are divided into blocks.
    pub blocks: Vec<FileBlocks>,
    /// How the files are transformed to the datum of the grid.
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

    /// The manifest's record of how these photos are created.
    #[must_use]
    pub fn record(&self) -> PhotoRecord {
        PhotoRecord { levels: self.levels(), quality: self.quality }
    }

    /// The number of texel levels finer than the finest cell.
    #[must_use]
    pub fn levels(&self) -> u8 {
        self.grid.texels().levels()
    }
}
