//! Which files a raster is read from.

use std::{
    collections::BTreeSet,
    io::Read as _,
    path::{Path, PathBuf},
};

use crate::files::open::open_dataset;
use crate::files::vsi::{self, VirtualFile};
use crate::{DemError, library_error};

/// How a virtual raster (VRT) begins, after white space and an XML declaration at most.
const VRT: &[u8] = b"<VRTDataset";
/// The text must begin within this many bytes of the file.
const VRT_BYTES: u64 = 512;

/// The files that GDAL reads a raster from, each once: the file itself, those beside it (`.aux.xml`, `.ovr`, `.prj`), and
/// of a virtual raster (VRT) the files that it refers to, also through other virtual rasters. Files that do not exist are
/// left out; a raster that is no file (a database's, a server's) has none.
///
/// # Errors
/// When GDAL cannot open the raster.
pub fn raster_files(path: &Path) -> Result<Vec<PathBuf>, DemError> {
    library_error::quiet();
    let mut files = vsi::file_list(&open_dataset(path)?);
    let mut seen: BTreeSet<PathBuf> = BTreeSet::from([path.to_path_buf()]);
    files.retain(|file| file == path || seen.insert(file.clone()));
    let mut at = 0;
    while let Some(file) = files.get(at) {
        if file != path && is_vrt(file) {
            // One that GDAL cannot open is told of when its heights are read.
            let nested = open_dataset(file).map(|dataset| vsi::file_list(&dataset));
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
