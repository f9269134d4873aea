//! The formats of vector files, and GDAL's drivers for them.

/// A file format of features.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VectorFormat {
    /// GeoPackage: an `SQLite` database with a spatial index.
    GeoPackage,
    /// FlatGeobuf: one layer with a spatial index, for reading by range requests.
    FlatGeobuf,
    /// GeoJSON, RFC 7946.
    GeoJson,
    /// Comma-separated values, lines as WKT.
    Csv,
}

impl VectorFormat {
    /// The name of GDAL's driver.
    pub(crate) fn driver(self) -> &'static str {
        match self {
            Self::GeoPackage => "GPKG",
            Self::FlatGeobuf => "FlatGeobuf",
            Self::GeoJson => "GeoJSON",
            Self::Csv => "CSV",
        }
    }
}
