//! The formats of vector files, their endings and GDAL's drivers for them.

use crate::file_format::FileFormat;

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

impl FileFormat for VectorFormat {
    const ALL: &[Self] = &[Self::GeoPackage, Self::FlatGeobuf, Self::GeoJson, Self::Csv];

    fn ending(self) -> &'static str {
        match self {
            Self::GeoPackage => "gpkg",
            Self::FlatGeobuf => "fgb",
            Self::GeoJson => "geojson",
            Self::Csv => "csv",
        }
    }
}

impl VectorFormat {
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
