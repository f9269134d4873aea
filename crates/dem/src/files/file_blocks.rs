//! What a reader of a file must hold in memory at least.

use std::path::{Path, PathBuf};

use gdal::Dataset;

use crate::DemError;
use crate::files::open::open_dataset;
use crate::files::raster_files::raster_files;

/// How a file is cut into blocks: the least that GDAL can read of it, always decoded whole.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileBlocks {
    /// The file.
    pub path: PathBuf,
    /// Columns and rows of the file, samples.
    pub size: [u64; 2],
    /// Columns and rows of a block, samples. The whole file where its format is decoded as a whole.
    pub block: [u64; 2],
    /// Size of a sample as it is stored.
    pub sample_bytes: u64,
    /// Size of the file on disk; 0 where it is none.
    pub file_bytes: u64,
}

impl FileBlocks {
    /// A block, decoded, and what it is decoded from, which takes its share of the file.
    #[must_use]
    pub fn block_bytes(&self) -> u64 {
        let samples = |[columns, rows]: [u64; 2]| columns.saturating_mul(rows);
        let block = samples(self.block);
        // A compressed block is smaller than its samples; a file may hold overviews and masks besides.
        let decoded = block.saturating_mul(self.sample_bytes);
        let share = block as f64 / samples(self.size).max(1) as f64;
        decoded.saturating_add(((self.file_bytes as f64 * share) as u64).min(decoded))
    }

    /// All blocks beside each other from the west to the east side: as long as they are kept, no block is read twice.
    #[must_use]
    pub fn row_bytes(&self) -> u64 {
        let across = self.size[0].div_ceil(self.block[0].max(1));
        let block = self.block[0].saturating_mul(self.block[1]).saturating_mul(self.sample_bytes);
        across.saturating_mul(block)
    }

    /// The blocks of a band, or of the first one where the file has fewer.
    fn of(path: &Path, dataset: &Dataset, band: usize) -> Option<Self> {
        let has_it = band <= dataset.raster_count();
        let band = dataset.rasterband(if has_it { band } else { 1 }).ok()?;
        let (columns, rows) = dataset.raster_size();
        let size = [columns as u64, rows as u64];
        let (block_columns, block_rows) = band.block_size();
        // Decoders of JPEG 2000 offer small blocks, and decode the whole image for one where it was not written in tiles.
        let is_whole = dataset.driver().short_name().starts_with("JP2");
        let block = [block_columns as u64, block_rows as u64];
        Some(Self {
            path: path.to_path_buf(),
            size,
            block: if is_whole { size } else { block },
            sample_bytes: u64::from(band.band_type().bytes()),
            file_bytes: std::fs::metadata(path).map_or(0, |found| found.len()),
        })
    }
}

/// The blocks of a file's band; of a virtual raster (VRT) also those of the files that it refers to.
pub(crate) fn of_file(path: &Path, band: usize) -> Result<Vec<FileBlocks>, DemError> {
    let dataset = open_dataset(path)?;
    let mut found: Vec<FileBlocks> = FileBlocks::of(path, &dataset, band).into_iter().collect();
    if dataset.driver().short_name() == "VRT" {
        for part in raster_files(path)?.iter().filter(|part| *part != path) {
            // Not every part is a raster.
            let dataset = open_dataset(part).ok();
            found.extend(dataset.and_then(|dataset| FileBlocks::of(part, &dataset, band)));
        }
    }
    Ok(found)
}
