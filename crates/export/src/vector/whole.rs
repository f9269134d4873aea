//! Whether a file that was written is there as a whole.

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

/// How GDAL begins the line of a feature.
const FEATURE: &[u8] = b"{ \"type\": \"Feature\"";

/// What is in a file of features.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Contents {
    pub(crate) features: u64,
    /// How many vertices all features have.
    pub(crate) vertices: u64,
}

/// Whether a file holds what was written to it, by reading all of it; no more of it is in memory than one feature.
///
/// What a file says of itself is not asked: a header or a table with the number of features is written long before the disk is full.
pub(crate) fn check(
    path: &Path,
    format: VectorFormat,
    written: Contents,
) -> Result<(), GdalFileError> {
    let failed = |source| GdalFileError::ReadAgain { path: path.to_path_buf(), source };
    let found = match format {
        // A row that is cut off is a row for GDAL; and GDAL ends both with a line.
        VectorFormat::Csv | VectorFormat::GeoJson if !ends_a_line(path).map_err(failed)? => {
            Contents::default()
        }
        VectorFormat::GeoPackage if !has_all_pages(path).map_err(failed)? => Contents::default(),
        // GDAL would read all of a GeoJSON file into memory.
        VectorFormat::GeoJson => {
            let features = count_lines(path).map_err(failed)?;
            Contents { features, vertices: written.vertices }
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

/// Reads every feature with its geometry. Empty where the format itself finds damage.
fn read_all(path: &Path, format: VectorFormat) -> Result<Contents, GdalError> {
    let options =
        DatasetOptions { open_flags: GdalOpenFlags::GDAL_OF_VECTOR, ..DatasetOptions::default() };
    let dataset = Dataset::open_ex(path, options)?;
    if format == VectorFormat::GeoPackage && !is_sound(&dataset)? {
        return Ok(Contents::default());
    }
    let mut contents = Contents::default();
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

/// What `SQLite` finds in its pages and indices, the spatial one included.
fn is_sound(dataset: &Dataset) -> Result<bool, GdalError> {
    let Some(mut found) = dataset.execute_sql("PRAGMA quick_check", None, Dialect::DEFAULT)? else {
        return Ok(false);
    };
    let first = found.features().next();
    Ok(first.and_then(|row| row.field_as_string(0).ok().flatten()).as_deref() == Some("ok"))
}

/// Whether an `SQLite` file is as long as its header says: what is missing of its last page is not noticed where that page is not in use.
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
