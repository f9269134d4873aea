//! GDAL opens a raster, and an error says which of the usual things went wrong.

use std::path::Path;

use gdal::Dataset;

use super::stand_in::stand_in;
use crate::{DemError, formats::lacks_format_of, library_error};

/// Opens a file, with an error that says which of the usual things went wrong.
pub(crate) fn open_dataset(path: &Path) -> Result<Dataset, DemError> {
    let own = || path.to_path_buf();
    if path.to_str().is_none() {
        return Err(DemError::NotUtf8 { path: own() });
    }
    if path.starts_with("/vsistdin") {
        return Err(DemError::Stream { path: own(), found: "standard input" });
    }
    // GDAL's virtual files and subdatasets ("/vsizip/…", "NETCDF:…") are no names of files.
    let is_virtual =
        path.to_str().is_some_and(|text| text.starts_with("/vsi") || text.contains(':'));
    match std::fs::metadata(path) {
        Ok(found) if found.is_file() && found.len() == 0 => {
            return Err(DemError::Empty { path: own() });
        }
        Ok(found) if !found.is_file() && !found.is_dir() => {
            return Err(DemError::Stream { path: own(), found: "a pipe or a device" });
        }
        Err(source) if !is_virtual => return Err(DemError::Missing { path: own(), source }),
        // Some formats are folders; GDAL says below whether this is one of them.
        Ok(_) | Err(_) => {}
    }
    library_error::forget();
    Dataset::open(path).map_err(|source| {
        if let Some((found, advice)) = stand_in(path) {
            DemError::StandIn { path: own(), found, advice }
        } else if let Some(advice) = lacks_format_of(path) {
            DemError::NoDriver { path: own(), advice }
        } else if path.is_dir() {
            DemError::NotAFile { path: own() }
        } else if let Some(fault) = fault_of_hgt(path) {
            fault
        } else {
            DemError::Open { path: own(), source: source.into() }
        }
    })
}

/// What is wrong with a file of SRTM that GDAL does not open: it has nothing but samples, so its size says their number and its name their place.
fn fault_of_hgt(path: &Path) -> Option<DemError> {
    if !path.extension()?.eq_ignore_ascii_case("hgt") {
        return None;
    }
    let (path, bytes) = (path.to_path_buf(), std::fs::metadata(path).ok()?.len());
    if HGT_BYTES.contains(&bytes) {
        return Some(DemError::HgtName { path });
    }
    Some(DemError::HgtSize { path, bytes })
}

/// Sizes of whole files: 2 bytes for each of 1201², 1801 × 3601 and 3601² samples.
const HGT_BYTES: [u64; 3] = [2_884_802, 12_970_802, 25_934_402];
