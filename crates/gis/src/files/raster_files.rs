//! The files of a raster, their blocks, and whether a mask matters, as needed by the reader.

use std::{
    collections::BTreeSet,
    io::Read as _,
    path::{Path, PathBuf},
};

use gdal::Dataset;
use gdal::raster::RasterBand;

use crate::files::open::open_raster;
use crate::files::vsi::{self, VirtualFile};
use crate::{FileUse, RasterError, library_error};

/// The beginning of a virtual raster (VRT), after at most white space and an XML declaration.
const VRT: &[u8] = b"<VRTDataset";
/// The text must begin within this many bytes of the file.
const VRT_BYTES: u64 = 512;

/// The files from which GDAL reads a raster, each once: the file itself, the files next to it
/// (`.aux.xml`, `.ovr`, `.prj`), and for a virtual raster (VRT) the files that it refers to, also
/// through other virtual rasters. Files that do not exist are omitted; a raster that is not a file
/// (in a database, on a server) has none.
/// database's, a server's) has none.
///
/// # Errors
/// When GDAL cannot open the raster.
pub fn raster_files(path: &Path) -> Result<Vec<PathBuf>, RasterError> {
    library_error::quiet();
    let mut files = vsi::file_list(&open_raster(path, FileUse::Dem)?);
    let mut seen: BTreeSet<PathBuf> = BTreeSet::from([path.to_path_buf()]);
    files.retain(|file| file == path || seen.insert(file.clone()));
    let mut at = 0;
    while let Some(file) = files.get(at) {
        if file != path && is_vrt(file) {
            // A file that GDAL cannot open is reported when its heights are read.
            let nested = open_raster(file, FileUse::Dem).map(|dataset| vsi::file_list(&dataset));
            let new: Vec<PathBuf> = nested.unwrap_or_default();
            files.extend(new.into_iter().filter(|file| seen.insert(file.clone())));
        }
        at += 1;
    }
    Ok(files)
}

fn is_vrt(path: &Path) -> bool {
    // Opening a pipe would block until something is written to it.
    if std::fs::metadata(path).is_ok_and(|found| !found.is_file()) {
        return false;
    }
    let mut start = Vec::new();
    let read =
        VirtualFile::open(path).and_then(|file| file.take(VRT_BYTES).read_to_end(&mut start));
    read.is_ok() && start.windows(VRT.len()).any(|window| window == VRT)
}

/// The blocks of a file: the smallest units that GDAL can read, which are always decoded
/// completely.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileBlocks {
    /// The file.
    pub path: PathBuf,
    /// Columns and rows of the file, in samples.
    pub size: [u64; 2],
    /// Columns and rows of a block, in samples. The whole file if its format is decoded as a whole.
    pub block: [u64; 2],
    /// The stored size of a sample.
    pub sample_bytes: u64,
    /// The size of the file on disk; 0 if it is not a file.
    pub file_bytes: u64,
}

impl FileBlocks {
    /// The size of a decoded block and of its compressed data, which is a proportional part of the
    /// file.
    #[must_use]
    pub fn block_bytes(&self) -> u64 {
        let samples = |[columns, rows]: [u64; 2]| columns.saturating_mul(rows);
        let block = samples(self.block);
        // A compressed block is smaller than its samples; a file may also contain overviews and
        // masks.
        let decoded = block.saturating_mul(self.sample_bytes);
        let share = block as f64 / samples(self.size).max(1) as f64;
        decoded.saturating_add(((self.file_bytes as f64 * share) as u64).min(decoded))
    }

    /// The size of all blocks in a row from the west to the east side: while they are cached, no
    /// block is read twice.
    #[must_use]
    pub fn row_bytes(&self) -> u64 {
        let across = self.size[0].div_ceil(self.block[0].max(1));
        let block = self.block[0].saturating_mul(self.block[1]).saturating_mul(self.sample_bytes);
        across.saturating_mul(block)
    }

    /// The blocks of a band, or of the first band if the file has fewer.
    fn from_dataset(path: &Path, dataset: &Dataset, band: usize) -> Option<Self> {
        let has_it = band <= dataset.raster_count();
        let band = dataset.rasterband(if has_it { band } else { 1 }).ok()?;
        let (columns, rows) = dataset.raster_size();
        let size = [columns as u64, rows as u64];
        let (block_columns, block_rows) = band.block_size();
        // Decoders of JPEG 2000 offer small blocks, and decode the whole image for one block if the
        // image is not tiled.
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

    /// The blocks of a file's band; for a virtual raster (VRT) also those of the files that it
    /// refers to.
    ///
    /// # Errors
    /// When the file cannot be opened.
    pub fn of_file(path: &Path, band: usize, kind: FileUse) -> Result<Vec<Self>, RasterError> {
        let dataset = open_raster(path, kind)?;
        let mut found: Vec<Self> = Self::from_dataset(path, &dataset, band).into_iter().collect();
        if dataset.driver().short_name() == "VRT" {
            for part in raster_files(path)?.iter().filter(|part| *part != path) {
                // Not every part is a raster.
                let dataset = open_raster(part, kind).ok();
                found.extend(dataset.and_then(|dataset| Self::from_dataset(part, &dataset, band)));
            }
        }
        Ok(found)
    }
}

/// Whether a band has a mask that goes beyond its own nodata and alpha bands, which readers see in
/// the values themselves. A nodata mask of the whole dataset is an example: its item
/// `NODATA_VALUES`, which no band has.
///
/// # Errors
/// When GDAL fails.
pub fn has_own_mask(band: &RasterBand<'_>) -> gdal::errors::Result<bool> {
    let flags = band.mask_flags()?;
    let is_own_nodata = flags.is_nodata() && !flags.is_per_dataset();
    Ok(!flags.is_all_valid() && !flags.is_alpha() && !is_own_nodata)
}
