//! Opens vector files through GDAL and reads them to their end; pipes and devices are rejected.

use std::{fs, path::Path};

use gdal::vector::{Feature, Layer, LayerAccess};
use gdal::{Dataset, DatasetOptions, GdalOpenFlags};

use crate::files::open::{is_virtual, stand_in};
use crate::{FileUse, LibraryError, VectorError, formats::lacks_format_of, library_error};

/// Opens a vector file of any format that GDAL reads, or a name that GDAL knows, such as
/// `/vsizip/…`.
///
/// # Errors
/// When the file does not exist, or GDAL cannot read it.
pub fn open_vectors(path: &Path, kind: FileUse) -> Result<Dataset, VectorError> {
    library_error::quiet();
    let own = || path.to_path_buf();
    match fs::metadata(path) {
        // Opening a pipe would block until something is written to it.
        Ok(found) if !found.is_file() && !found.is_dir() => {
            return Err(VectorError::Stream { kind, path: own() });
        }
        Err(source) if !path.to_str().is_some_and(is_virtual) => {
            return Err(VectorError::Missing { kind, path: own(), source });
        }
        Ok(_) | Err(_) => {}
    }
    library_error::forget();
    let open_flags = GdalOpenFlags::GDAL_OF_VECTOR | GdalOpenFlags::GDAL_OF_READONLY;
    let options = DatasetOptions { open_flags, ..DatasetOptions::default() };
    Dataset::open_ex(path, options).map_err(|source| {
        let source = match stand_in(path) {
            Some((found, advice)) => {
                Box::new(LibraryError::from_message(format!("it is {found}; {advice}")))
            }
            None => match lacks_format_of(path) {
                Some(advice) => return VectorError::NoDriver { path: own(), advice },
                None => source.into(),
            },
        };
        VectorError::Open { kind, path: own(), source }
    })
}

/// Passes all features of a layer to `take`.
///
/// # Errors
/// Those of `take`, and when not all features can be read.
pub fn for_each_feature<E: From<VectorError>>(
    layer: &mut Layer<'_>,
    (path, kind): (&Path, FileUse),
    mut take: impl FnMut(&Feature<'_>) -> Result<(), E>,
) -> Result<(), E> {
    let path = || path.to_path_buf();
    let (name, claimed) = (layer.name(), layer.try_feature_count());
    let mut found = 0;
    library_error::forget();
    for feature in layer.features() {
        found += 1;
        take(&feature)?;
    }
    // The iterator ends at a feature that cannot be read, without an error.
    if let Some(source) = library_error::failure() {
        return Err(VectorError::Damaged { kind, path: path(), source }.into());
    }
    match claimed.filter(|claimed| *claimed != found) {
        Some(claimed) => {
            Err(VectorError::CutOff { kind, path: path(), layer: name, claimed, found }.into())
        }
        None => Ok(()),
    }
}
