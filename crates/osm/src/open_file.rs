use std::{
    fs::{self, File},
    path::Path,
};

use crate::ReadOsmError;

/// Opens an extract, which must be a file.
pub(crate) fn open_file(path: &Path) -> Result<File, ReadOsmError> {
    let not_open = |source| ReadOsmError::Open { path: path.to_path_buf(), source };
    // Opening a pipe would block until something is written to it.
    let kind = fs::metadata(path).map_err(not_open)?.file_type();
    if !kind.is_file() {
        let found = if kind.is_dir() { "a folder" } else { "a pipe or a device" };
        return Err(ReadOsmError::NotAFile { path: path.to_path_buf(), found });
    }
    File::open(path).map_err(not_open)
}
