//! The formats of vector files, their endings and GDAL's drivers for them.

use std::path::Path;

/// A file format of features.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VectorFormat {
    /// GeoPackage: an `SQLite` database with a spatial index.
    GeoPackage,
    /// FlatGeobuf: one layer with a spatial index, to be read by ranges.
    FlatGeobuf,
    /// GeoJSON, RFC 7946.
    GeoJson,
    /// Comma-separated values, lines as WKT.
    Csv,
}

impl VectorFormat {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::GeoPackage, Self::FlatGeobuf, Self::GeoJson, Self::Csv];

    /// The ending of its files, without the point.
    #[must_use]
    pub fn ending(self) -> &'static str {
        match self {
            Self::GeoPackage => "gpkg",
            Self::FlatGeobuf => "fgb",
            Self::GeoJson => "geojson",
            Self::Csv => "csv",
        }
    }

    /// The format of a file by its ending, in capitals or not; `None` for another ending.
    #[must_use]
    pub fn of_path(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        Self::ALL.into_iter().find(|format| format.ending() == ending)
    }

    /// GDAL's driver.
    pub(crate) fn driver(self) -> &'static str {
        match self {
            Self::GeoPackage => "GPKG",
            Self::FlatGeobuf => "FlatGeobuf",
            Self::GeoJson => "GeoJSON",
            Self::Csv => "CSV",
        }
    }
}
