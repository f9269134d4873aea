//! Checks whether a written file is complete.

use std::{
    fs::File,
    io::{self, BufRead as _, BufReader, Read as _, Seek as _, SeekFrom},
    path::Path,
};

use corniche_store::LackOfRoom;
use gdal::{
    Dataset, DatasetOptions, GdalOpenFlags,
    errors::GdalError,
    vector::{Geometry, LayerAccess as _, sql::Dialect},
};

use crate::{error::GdalFileError, vector::format::VectorFormat};

/// The beginning of a feature's line in GDAL's output.
const FEATURE: &[u8] = b"{ \"type\": \"Feature\"";

/// The contents of a file of features.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct FeatureFileContents {
    pub(crate) features: u64,
    /// The number of vertices of all features.
    pub(crate) vertices: u64,
}

/// Whether a file contains everything that was written to it. All of it is read, but only one
/// feature at a time is in memory.
///
/// The file's own counts are not trusted: a header or a table with the number of features is
/// written long before the disk is full.
pub(crate) fn check(
    path: &Path,
    format: VectorFormat,
    written: FeatureFileContents,
) -> Result<(), GdalFileError> {
    let failed = |source| GdalFileError::ReadAgain { path: path.to_path_buf(), source };
    let found = match format {
        // GDAL reads a truncated row as a row, and GDAL ends both formats with a line break.
        VectorFormat::Csv | VectorFormat::GeoJson if !ends_a_line(path).map_err(failed)? => {
            FeatureFileContents::default()
        }
        VectorFormat::GeoPackage if !has_all_pages(path).map_err(failed)? => {
            FeatureFileContents::default()
        }
        // GDAL would read all of a GeoJSON file into memory.
        VectorFormat::GeoJson => {
            let features = count_lines(path).map_err(failed)?;
            FeatureFileContents { features, vertices: written.vertices }
        }
        _ => read_all(path, format).map_err(|error| failed(io::Error::other(error)))?,
    };
    if found == written {
        return Ok(());
    }
    Err(GdalFileError::NotWhole {
        path: path.to_path_buf(),
        room: LackOfRoom::at(path),
        written: written.features,
        found: found.features,
    })
}

/// Reads every feature with its geometry. Returns no contents if the format itself detects damage.
fn read_all(path: &Path, format: VectorFormat) -> Result<FeatureFileContents, GdalError> {
    let options =
        DatasetOptions { open_flags: GdalOpenFlags::GDAL_OF_VECTOR, ..DatasetOptions::default() };
    let dataset = Dataset::open_ex(path, options)?;
    if format == VectorFormat::GeoPackage && !is_sound(&dataset)? {
        return Ok(FeatureFileContents::default());
    }
    let mut contents = FeatureFileContents::default();
    let mut layer = dataset.layer(0)?;
    for feature in layer.features() {
        contents.features += 1;
        contents.vertices += feature.geometry().map_or(0, vertices);
    }
    Ok(contents)
}

/// Vertices of a geometry and of all its parts.
fn vertices(geometry: &Geometry) -> u64 {
    let parts = (0..geometry.geometry_count()).map(|part| vertices(&geometry.get_geometry(part)));
    let own = if geometry.geometry_count() == 0 { geometry.point_count() as u64 } else { 0 };
    own + parts.sum::<u64>()
}

/// Whether `SQLite` finds no errors in its pages and indices, including the spatial one.
fn is_sound(dataset: &Dataset) -> Result<bool, GdalError> {
    let Some(mut found) = dataset.execute_sql("PRAGMA quick_check", None, Dialect::DEFAULT)? else {
        return Ok(false);
    };
    let first = found.features().next();
    Ok(first.and_then(|row| row.field_as_string(0).ok().flatten()).as_deref() == Some("ok"))
}

/// Whether an `SQLite` file is as long as its header states: a truncated last page is not noticed
/// if it is not in use.
///
/// Source: *Database File Format*, sqlite.org, 1.3.
fn has_all_pages(path: &Path) -> io::Result<bool> {
    let mut file = File::open(path)?;
    let mut header = [0; 32];
    file.read_exact(&mut header)?;
    let [high, low] = [header[16], header[17]];
    let page_bytes = match u16::from_be_bytes([high, low]) {
        1 => 65_536,
        bytes => u64::from(bytes),
    };
    let pages = u32::from_be_bytes([header[28], header[29], header[30], header[31]]);
    Ok(file.metadata()?.len() == page_bytes * u64::from(pages))
}

fn ends_a_line(path: &Path) -> io::Result<bool> {
    let mut file = File::open(path)?;
    if file.seek(SeekFrom::End(0))? == 0 {
        return Ok(false);
    }
    file.seek(SeekFrom::End(-1))?;
    let mut last = [0];
    file.read_exact(&mut last)?;
    Ok(last == *b"\n")
}

/// Counts the features of a GeoJSON file, which GDAL writes one per line. Returns 0 if its end is
/// missing.
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
            // The last line is a bracket: only the beginning of other lines is kept.
            last.extend(&text[..text.len().min(8)]);
        }
        line.clear();
    }
    Ok(if last == b"}" { features } else { 0 })
}
