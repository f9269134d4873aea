//! The formats that the manual promises, and a check for those that the installed GDAL lacks.

use std::path::Path;

use gdal::{DriverManager, Metadata as _, version::VersionInfo};

/// A format: its name for people, GDAL's name of its driver, and the endings of its files.
type Format = (&'static str, &'static str, &'static [&'static str]);

/// The formats of elevation files and photos, and of lines and areas, that are read or written.
const FORMATS: [Format; 16] = [
    ("GeoTIFF", GEOTIFF, &["tif", "tiff"]),
    ("HGT", "SRTMHGT", &["hgt"]),
    ("VRT", "VRT", &["vrt"]),
    ("ASC", "AAIGrid", &["asc"]),
    ("NetCDF", "netCDF", &["nc"]),
    ("JPEG 2000", "JP2OpenJPEG", &["jp2", "j2k"]),
    ("PNG", "PNG", &["png"]),
    ("JPEG", "JPEG", &["jpg", "jpeg"]),
    ("GeoPackage", "GPKG", &["gpkg"]),
    ("FlatGeobuf", "FlatGeobuf", &["fgb"]),
    ("GeoJSON", "GeoJSON", &["geojson"]),
    ("Shapefile", "ESRI Shapefile", &["shp"]),
    ("GPX", "GPX", &["gpx"]),
    ("KML", "KML", &["kml"]),
    ("CSV", "CSV", &["csv"]),
    // GDAL has this driver if it can fetch files; the driver reads no files itself.
    ("files on servers", "HTTP", &[]),
];

/// Common formats that the manual does not promise: if GDAL lacks one, its files are not reported
/// as corrupt.
const OTHERS: [Format; 19] = [
    ("GML", "GML", &["gml"]),
    ("DXF", "DXF", &["dxf"]),
    ("DWG", "CAD", &["dwg"]),
    ("DGN", "DGN", &["dgn"]),
    ("MapInfo", "MapInfo File", &["tab", "mif"]),
    ("File Geodatabase", "OpenFileGDB", &["gdb"]),
    ("KMZ", "LIBKML", &["kmz"]),
    ("SQLite", "SQLite", &["sqlite"]),
    ("TopoJSON", "TopoJSON", &["topojson"]),
    ("Parquet", "Parquet", &["parquet"]),
    ("OpenDocument", "ODS", &["ods"]),
    ("Excel", "XLSX", &["xlsx"]),
    ("PDF", "PDF", &["pdf"]),
    ("Erdas Imagine", "HFA", &["img"]),
    ("ECW", "ECW", &["ecw"]),
    ("MrSID", "MrSID", &["sid"]),
    ("DTED", "DTED", &["dt0", "dt1", "dt2"]),
    ("GRIB", "GRIB", &["grib", "grib2", "grb"]),
    ("HDF5", "HDF5", &["h5", "hdf5"]),
];

const GEOTIFF: &str = "GTiff";

/// Compressions of GeoTIFF in elevation files and photos, as GDAL names them. Each needs a separate
/// library, or a part of libtiff.
const COMPRESSIONS: [&str; 9] =
    ["LZW", "PACKBITS", "JPEG", "DEFLATE", "LZMA", "ZSTD", "WEBP", "LERC", "LERC_ZSTD"];

/// The names of the formats, and of the compressions of GeoTIFF, that this GDAL lacks.
#[must_use]
pub fn missing_formats() -> Vec<String> {
    let formats = FORMATS.iter().filter(|format| is_missing(format));
    let names = formats.map(|&(name, ..)| name.to_owned());
    // If the driver can write a compression, it can read it, too. Without the driver, its
    // compressions are not listed.
    let options = DriverManager::get_driver_by_name(GEOTIFF)
        .ok()
        .map(|driver| driver.metadata_item("DMD_CREATIONOPTIONLIST", "").unwrap_or_default());
    let compressions = options.map(|options| missing_compressions(&options)).unwrap_or_default();
    names.chain(compressions.into_iter().map(|name| format!("GeoTIFF with {name}"))).collect()
}

fn is_missing((_, driver, _): &Format) -> bool {
    DriverManager::get_driver_by_name(driver).is_err()
}

/// The compressions that a driver's list of creation options, which is XML, does not name.
fn missing_compressions(options: &str) -> Vec<&'static str> {
    let from = options.find("'COMPRESS'").or_else(|| options.find("\"COMPRESS\""));
    let named = from.map_or("", |from| &options[from..]);
    let named = named.split_once("</Option>").map_or("", |(named, _)| named);
    let lacks = |name: &&str| !named.contains(&format!("<Value>{name}</Value>"));
    COMPRESSIONS.into_iter().filter(lacks).collect()
}

/// A message that GDAL lacks the format of a file, by the ending of its name, and what to do;
/// `None` if this is not so.
pub(crate) fn lacks_format_of(path: &Path) -> Option<String> {
    let ending = path.extension()?.to_str()?.to_ascii_lowercase();
    let mut formats = FORMATS.iter().chain(&OTHERS);
    let format = formats.find(|(.., endings)| endings.contains(&ending.as_str()))?;
    is_missing(format).then(|| advice(format))
}

fn advice((name, driver, _): &Format) -> String {
    format!(
        "GDAL {} in this program does not read {name}; convert the file with ogr2ogr (lines and areas, to .gpkg) or gdal_translate (rasters, to .tif) \
         of a GDAL that has the driver {driver}",
        VersionInfo::release_name(),
    )
}

#[cfg(test)]
#[path = "formats_tests.rs"]
mod tests;
