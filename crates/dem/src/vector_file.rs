//! Vector files are opened through GDAL, and pipes and devices are refused.

use std::{fs, io, path::Path};

use gdal::{Dataset, DatasetOptions, GdalOpenFlags};

use crate::{LibraryError, files::stand_in::stand_in, formats::lacks_format_of, library_error};

/// Why a vector file cannot be opened.
#[derive(Debug)]
pub enum NotOpened {
    /// There is no such file, or it may not be read.
    Missing(io::Error),
    /// It is a pipe or a device: opening it would block until something is written to it.
    Stream,
    /// GDAL was built without its format; with what to do.
    NoDriver(String),
    /// GDAL cannot read it.
    Unreadable(Box<LibraryError>),
}

/// Opens a vector file of any format that GDAL reads, or a name that GDAL knows, such as `/vsizip/…`.
///
/// # Errors
/// When there is no such file, or GDAL cannot read it.
pub fn open_vectors(path: &Path) -> Result<Dataset, NotOpened> {
    library_error::quiet();
    let is_virtual =
        path.to_str().is_some_and(|text| text.starts_with("/vsi") || text.contains(':'));
    match fs::metadata(path) {
        Ok(found) if !found.is_file() && !found.is_dir() => return Err(NotOpened::Stream),
        Err(source) if !is_virtual => return Err(NotOpened::Missing(source)),
        Ok(_) | Err(_) => {}
    }
    library_error::forget();
    let open_flags = GdalOpenFlags::GDAL_OF_VECTOR | GdalOpenFlags::GDAL_OF_READONLY;
    let options = DatasetOptions { open_flags, ..DatasetOptions::default() };
    Dataset::open_ex(path, options).map_err(|source| {
        if let Some((found, advice)) = stand_in(path) {
            let words = format!("it is {found}; {advice}");
            NotOpened::Unreadable(Box::new(LibraryError::of(words)))
        } else if let Some(advice) = lacks_format_of(path) {
            NotOpened::NoDriver(advice)
        } else {
            NotOpened::Unreadable(source.into())
        }
    })
}
