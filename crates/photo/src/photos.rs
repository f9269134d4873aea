//! Photo files that are described but not held open, and the choice of the resolution of their
//! texels.

use std::path::PathBuf;

use corniche_dem::GridPlan;
use corniche_geom::Bounds;
use corniche_gis::{FileBlocks, FileUse, PlacedRaster};

use crate::photo_file::{PhotoFile, overlap};
use crate::{PhotoError, PhotoGrid, TexelGrid};

/// The most levels finer than the finest cell by default: a finest tile then has 2048 texels per
/// side.
const USUAL_LEVELS: u8 = 3;
/// The most levels that can be chosen.
const MOST_LEVELS: u8 = 16;
/// The largest size of a texel in pixels when the number of levels is chosen automatically.
const PIXELS_PER_TEXEL: f64 = 1.5;
/// The most pixels along a texel: the pixels of one texel must fit into memory.
const MOST_PIXELS_PER_TEXEL: f64 = 1000.0;

/// Photos, described but not held open.
#[derive(Debug, Clone)]
pub struct Photos {
    files: Vec<PhotoFile>,
}

/// The number of levels of texels finer than the finest cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LevelChoice {
    /// Uses as many levels as the finest photo has detail for, at most three.
    OfPhotos,
    /// Uses this number of levels.
    Given(u8),
    /// Uses as many levels as the finest photo has detail for, or fewer if that suffices for texels
    /// of this size, metres; for reading by windows, not by whole tiles.
    NotCoarserThan(f64),
}

impl Photos {
    /// The georeference of each photo.
    pub fn rasters(&self) -> impl Iterator<Item = &PlacedRaster> {
        self.files.iter().map(|file| &file.raster)
    }

    /// Inspects all files without reading pixels. Where photos overlap, the first in the list is on
    /// top.
    ///
    /// # Errors
    /// When a file cannot be opened, has no georeference or CRS, has samples of other than 8 bits,
    /// or has bands that are not colours.
    pub fn open(files: &[PathBuf]) -> Result<Self, PhotoError> {
        if files.is_empty() {
            return Err(PhotoError::NoFiles);
        }
        let files = files.iter().map(|path| PhotoFile::open(path)).collect::<Result<_, _>>()?;
        Ok(Self { files })
    }

    /// Returns the copyright in the files' metadata, each once, in the order of the files.
    #[must_use]
    pub fn credits(&self) -> Vec<String> {
        let mut credits: Vec<String> = Vec::new();
        for credit in self.files.iter().filter_map(|file| file.credit.as_ref()) {
            if !credits.contains(credit) {
                credits.push(credit.clone());
            }
        }
        credits
    }

    /// Returns the layout of each file's blocks.
    ///
    /// # Errors
    /// When a file cannot be opened again.
    pub fn file_blocks(&self) -> Result<Vec<FileBlocks>, PhotoError> {
        let blocks = |file: &PhotoFile| FileBlocks::of_file(file.raster.path(), 1, FileUse::Photo);
        Ok(self.files.iter().map(blocks).collect::<Result<Vec<_>, _>>()?.concat())
    }

    /// Places the photos on a grid.
    ///
    /// # Errors
    /// When none of them overlaps the data of the grid, one cannot be transformed to the grid's CRS
    /// or has far more detail than the texels, or there are too many levels.
    pub fn on(&self, grid: &GridPlan, choice: LevelChoice) -> Result<PhotoGrid, PhotoError> {
        let mut photos = Vec::with_capacity(self.files.len());
        let mut all = Bounds::EMPTY;
        for file in &self.files {
            let placed = file.on(grid)?;
            all.include([placed.bounds.min_x, placed.bounds.min_y]);
            all.include([placed.bounds.max_x, placed.bounds.max_y]);
            photos.push(placed);
        }
        photos.retain(|photo| overlap(&photo.bounds, &grid.data_bounds));
        let cell = grid.frame.cell();
        let finest_m = photos.iter().map(|photo| photo.pixel_m).reduce(f64::min);
        let Some(finest_m) = finest_m else {
            let (photos, ground) = (all.to_array(), grid.data_bounds.to_array());
            return Err(PhotoError::NoOverlap { photos, ground });
        };
        let texel_m = |levels: u8| cell.shorter_m() / f64::from(1_u32 << levels);
        let levels = match choice {
            LevelChoice::Given(levels) => levels,
            LevelChoice::NotCoarserThan(wanted_m) => {
                let finest_m = finest_m.max(wanted_m);
                let levels = (0..MOST_LEVELS).find(|&levels| texel_m(levels) <= finest_m);
                levels.unwrap_or(MOST_LEVELS)
            }
            LevelChoice::OfPhotos => (0..USUAL_LEVELS)
                .find(|&levels| texel_m(levels) <= PIXELS_PER_TEXEL * finest_m)
                .unwrap_or(USUAL_LEVELS),
        };
        let texels = match choice {
            LevelChoice::NotCoarserThan(_) => TexelGrid::of_any(grid.frame, levels),
            LevelChoice::Given(_) | LevelChoice::OfPhotos => TexelGrid::new(grid.frame, levels)?,
        };
        let most = MOST_PIXELS_PER_TEXEL;
        for photo in &photos {
            let pixels = texel_m(levels) / photo.pixel_m;
            if pixels > most {
                let path = photo.file.raster.path().to_path_buf();
                return Err(PhotoError::TooFine { path, pixels, most });
            }
        }
        Ok(PhotoGrid { photos, texels })
    }
}
