//! What the heights of a package are measured from, said when it is exported.

use corniche_dem::RecordedHeights;
use corniche_tileset::{FilePackage, VerticalRecord};

use crate::error::DatumError;

/// The same package, whose heights are those of `dem_vertical_crs` ("EPSG:n"), where it does not know what they are measured from: as if it had
/// been built with this `--dem-vertical-crs`, which changes no height.
///
/// # Errors
/// When the package knows it, or this is no vertical CRS in metres upwards.
pub fn with_vertical_crs(
    package: FilePackage,
    dem_vertical_crs: &str,
) -> Result<FilePackage, DatumError> {
    let datum = &package.manifest().vertical.datum;
    if datum != VerticalRecord::UNKNOWN_DATUM {
        return Err(DatumError::KnownDatum { datum: datum.clone() });
    }
    let found = RecordedHeights::datum_in_metres(dem_vertical_crs);
    let found = found.map_err(|source| DatumError::VerticalCrs(Box::new(source)))?;
    let datum =
        found.ok_or_else(|| DatumError::NotInMetres { text: dem_vertical_crs.to_owned() })?;
    Ok(package.with_datum(datum, dem_vertical_crs))
}
