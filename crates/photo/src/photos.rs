//! Photo files that are described but not held open, and the choice of how fine their texels
//! become.

use std::path::PathBuf;

use corniche_dem::GridPlan;
use corniche_geom::Bounds;
use corniche_gis::{FileBlocks, FileUse, PlacedRaster};

use crate::photo_file::{PhotoFile, overlap};
use crate::{PhotoError, PhotoGrid, TexelGrid};

/// The most levels finer than the finest cell that are taken where nobody says how many: a finest
/// tile then has 2048 texels a side.
const USUAL_LEVELS: u8 = 3;
/// The most levels at all.
const MOST_LEVELS: u8 = 16;
/// Texels may be so many pixels large where the number of levels is chosen.
const PIXELS_PER_TEXEL: f64 = 1.5;
/// The most pixels along a texel: what one texel is made of must fit into memory.
const MOST_PIXELS_PER_TEXEL: f64 = 1000.0;

/// Photos, described but not held open.
#[derive(Debug, Clone)]
pub struct Photos {
    files: Vec<PhotoFile>,
}

/// How many levels of texels finer than the finest cell there are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LevelChoice {
    /// There are as many levels as the finest photo has detail for, at most three.
    OfPhotos,
    /// There are so many levels.
    Given(u8),
    /// There are as many levels as the finest photo has detail for, or as make texels of so many
    /// metres if that is coarser; to be read by windows, not by whole tiles.
    NotCoarserThan(f64),
}

impl Photos {
    /// Where each of them lies.
    pub fn rasters(&self) -> impl Iterator<Item = &PlacedRaster> {
        self.files.iter().map(|file| &file.raster)
    }

    /// Looks into all files; reads no pixel yet. Where photos overlap, the first named lies on top.
    ///
    /// # Errors
    /// When a file cannot be opened, lacks georeference or CRS, has other samples than 8 bits, or
    /// bands that are no colours.
    pub fn open(files: &[PathBuf]) -> Result<Self, PhotoError> {
        if files.is_empty() {
            return Err(PhotoError::NoFiles);
        }
        let files = files.iter().map(|path| PhotoFile::open(path)).collect::<Result<_, _>>()?;
        Ok(Self { files })
    }

    /// What the files' metadata say of their rights, each once, in the order of the files.
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

    /// How each file is cut into blocks.
    ///
    /// # Errors
    /// When a file cannot be opened any more.
    pub fn file_blocks(&self) -> Result<Vec<FileBlocks>, PhotoError> {
        let blocks = |file: &PhotoFile| FileBlocks::of_file(file.raster.path(), 1, FileUse::Photo);
        Ok(self.files.iter().map(blocks).collect::<Result<Vec<_>, _>>()?.concat())
    }

    /// Puts the photos on a grid.
    ///
    /// # Errors
    /// When none of them lies on the data of the grid, one has no place in the grid's CRS or far
    /// more detail than the texels, or there are too many levels.
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
