//! Opens rasters with GDAL, and reports common problems, such as a failed download that was saved
//! in place of the file.

use std::{fs::File, io::Read as _, path::Path};

use gdal::Dataset;

use crate::formats::lacks_format_of;
use crate::{FileUse, NotUtf8, RasterError, library_error};

/// The number of files that a reader keeps open; each may hold a file handle of the system.
const OPEN_FILES: usize = 32;

/// Rasters kept open by one reader; the least recently used one is closed first.
#[derive(Default)]
pub struct OpenRasters {
    /// The most recently used come first, by numbers that the reader assigns.
    open: Vec<(usize, Dataset)>,
}

impl OpenRasters {
    /// A raster, which is opened if necessary.
    ///
    /// # Errors
    /// The errors of [`open_raster`].
    pub fn dataset(
        &mut self,
        index: usize,
        path: &Path,
        kind: FileUse,
    ) -> Result<&Dataset, RasterError> {
        if let Some(at) = self.open.iter().position(|(open, _)| *open == index) {
            self.open[..=at].rotate_right(1);
        } else {
            let dataset = open_raster(path, kind)?;
            self.open.truncate(OPEN_FILES - 1);
            self.open.insert(0, (index, dataset));
        }
        Ok(&self.open[0].1)
    }
}

/// The name of a file as GDAL accepts it.
pub(crate) fn utf8_name(path: &Path, kind: FileUse) -> Result<&str, NotUtf8> {
    path.to_str().ok_or_else(|| NotUtf8 { kind, path: path.to_path_buf() })
}

/// Whether a name is one of GDAL's virtual files or subdatasets (`/vsizip/…`, `NETCDF:…`), not the
/// name of a file.
pub(crate) fn is_virtual(name: &str) -> bool {
    name.starts_with("/vsi") || name.contains(':')
}

/// Opens a raster, with an error that reports common problems.
///
/// # Errors
/// When the file does not exist, is empty, a pipe or not a raster, or GDAL cannot read its format.
pub fn open_raster(path: &Path, kind: FileUse) -> Result<Dataset, RasterError> {
    let own = || path.to_path_buf();
    let is_virtual = is_virtual(utf8_name(path, kind)?);
    if path.starts_with("/vsistdin") {
        return Err(RasterError::Stream { path: own(), found: "standard input" });
    }
    match std::fs::metadata(path) {
        Ok(found) if found.is_file() && found.len() == 0 => {
            return Err(RasterError::Empty { path: own() });
        }
        Ok(found) if !found.is_file() && !found.is_dir() => {
            return Err(RasterError::Stream { path: own(), found: "a pipe or a device" });
        }
        Err(source) if !is_virtual => {
            return Err(RasterError::Missing { kind, path: own(), source });
        }
        // Some formats are folders; GDAL reports below whether this is one of them.
        Ok(_) | Err(_) => {}
    }
    library_error::forget();
    Dataset::open(path).map_err(|source| {
        if let Some((found, advice)) = stand_in(path) {
            RasterError::StandIn { path: own(), found, advice }
        } else if let Some(advice) = lacks_format_of(path) {
            RasterError::NoDriver { path: own(), advice }
        } else if path.is_dir() {
            RasterError::NotAFile { path: own() }
        } else if let Some(fault) = fault_of_hgt(path) {
            fault
        } else {
            RasterError::unreadable(path, source)
        }
    })
}

/// The problem of an SRTM file that GDAL does not open: it contains only samples, so its size gives
/// their number and its name their position.
fn fault_of_hgt(path: &Path) -> Option<RasterError> {
    if !path.extension()?.eq_ignore_ascii_case("hgt") {
        return None;
    }
    let (path, bytes) = (path.to_path_buf(), std::fs::metadata(path).ok()?.len());
    if HGT_BYTES.contains(&bytes) {
        return Some(RasterError::HgtName { path });
    }
    Some(RasterError::HgtSize { path, bytes })
}

/// Sizes of complete files: 2 bytes for each of 1201², 1801 × 3601 and 3601² samples.
const HGT_BYTES: [u64; 3] = [2_884_802, 12_970_802, 25_934_402];

/// The number of bytes of a file that are examined.
const START_BYTES: u64 = 4096;

/// What a file is that was saved in place of geodata, and what to do; `None` if it is nothing of
/// this kind, or cannot be read.
#[must_use]
pub fn stand_in(path: &Path) -> Option<(&'static str, &'static str)> {
    // Opening a pipe would block until something is written to it.
    if !path.is_file() {
        return None;
    }
    let mut start = Vec::new();
    File::open(path).ok()?.take(START_BYTES).read_to_end(&mut start).ok()?;
    let text = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&start).trim_ascii_start();
    let is = |name: &[u8]| text.get(..name.len()).is_some_and(|own| own.eq_ignore_ascii_case(name));
    let has = |word: &[u8]| text.windows(word.len()).any(|own| own.eq_ignore_ascii_case(word));
    if is(b"version https://git-lfs") {
        Some(("a Git LFS pointer", "download the file that it points to: git lfs pull"))
    } else if is(b"<!doctype html") || is(b"<html") || (is(b"<") && has(b"<html")) {
        Some(("an HTML page", "its download failed; download the file again"))
    } else if is(b"<") && has(b"ExceptionReport") {
        Some((
            "an error report of a server",
            "read it in an editor, correct the request and download the file again",
        ))
    } else {
        None
    }
}
