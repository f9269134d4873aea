//! Opens an extract as a file or as an object in object storage.

use std::{
    fs::{self, File},
    io::{self, Read, Seek},
    path::Path,
};

use corniche_objects::{ObjectAddress, ObjectError, ObjectReader, Storage, StorageSettings};

use crate::ReadOsmError;

/// An open extract: a file, or an object of which only the requested ranges are fetched.
pub(crate) type Extract = Box<dyn ExtractSource>;

/// What can be read in any order.
pub(crate) trait ExtractSource: Read + Seek {}

impl<T: Read + Seek> ExtractSource for T {}

/// Opens an extract: a file, or `/vsis3/BUCKET/NAME`, which is GDAL's name for an object.
pub(crate) fn open_file(path: &Path) -> Result<Extract, ReadOsmError> {
    let not_open = |source| ReadOsmError::Open { path: path.to_path_buf(), source };
    if let Some(name) = path.to_str().filter(|name| name.starts_with("/vsi") && !path.exists()) {
        return Ok(Box::new(open_object(name).map_err(not_open)?));
    }
    // Opening a pipe would block until something is written to it.
    let kind = fs::metadata(path).map_err(not_open)?.file_type();
    if !kind.is_file() {
        let found = if kind.is_dir() { "a folder" } else { "a pipe or a device" };
        return Err(ReadOsmError::NotAFile { path: path.to_path_buf(), found });
    }
    Ok(Box::new(File::open(path).map_err(not_open)?))
}

fn open_object(name: &str) -> io::Result<ObjectReader> {
    let address = match name.strip_prefix("/vsis3/") {
        Some(rest) => ObjectAddress::parse(&format!("s3://{rest}"))?,
        None => None,
    };
    let Some(ObjectAddress { bucket, key }) = address else {
        let what = "extracts are read from files or from object storage (s3://BUCKET/NAME); save this one to a file first";
        return Err(io::Error::new(io::ErrorKind::Unsupported, what));
    };
    let open = || {
        let storage = Storage::new(StorageSettings::of_environment())?;
        ObjectReader::open(storage.bucket(&bucket)?, &key, None)
    };
    open().map_err(|error: ObjectError| error.into())
}
