//! Whether a file that was written is there as a whole.

use std::{
    fs::File,
    io::{self, BufRead as _, BufReader},
    path::Path,
};

use gdal::{Dataset, DatasetOptions, GdalOpenFlags, errors::GdalError, vector::LayerAccess as _};

use crate::{error::ExportError, vector::format::VectorFormat};

/// How GDAL begins the line of a feature.
const FEATURE: &[u8] = b"{ \"type\": \"Feature\"";

/// How many features a file has, read from the file; no more of it is in memory than one line.
pub(crate) fn count_features(path: &Path, format: VectorFormat) -> Result<u64, ExportError> {
    let failed = |source| ExportError::ReadAgain { path: path.to_path_buf(), source };
    // GDAL would read all of a GeoJSON file into memory.
    if format == VectorFormat::GeoJson {
        return count_lines(path).map_err(failed);
    }
    let count = || {
        let options = DatasetOptions {
            open_flags: GdalOpenFlags::GDAL_OF_VECTOR,
            ..DatasetOptions::default()
        };
        let dataset = Dataset::open_ex(path, options)?;
        Ok(dataset.layer(0)?.feature_count())
    };
    count().map_err(|error: GdalError| failed(io::Error::other(error)))
}

/// The features of a GeoJSON file, which GDAL writes one in a line. 0 where its end is missing.
fn count_lines(path: &Path) -> io::Result<u64> {
    let mut file = BufReader::new(File::open(path)?);
    let mut line = Vec::new();
    let mut last: Vec<u8> = Vec::new();
    let mut features = 0;
    while file.read_until(b'\n', &mut line)? > 0 {
        features += u64::from(line.starts_with(FEATURE));
        let text = line.trim_ascii();
        if !text.is_empty() {
            last.clear();
            // The last line is a bracket: of others only the beginning is kept.
            last.extend(&text[..text.len().min(8)]);
        }
        line.clear();
    }
    Ok(if last == b"}" { features } else { 0 })
}
