//! The heights of a package: the elevation files from which it was built, their vertical datum, and
//! the largest error of heights, in words.

use corniche_dem::{Dem, GridPlan};
use corniche_gis::RecordedHeights;
use corniche_tileset::{FilePackage, Manifest, VerticalRecord};

use crate::error::DatumError;

/// The elevation files from which a package was built.
#[derive(Debug, Clone, Copy)]
pub struct Elevation<'a> {
    /// The files, opened in the same way as for the build.
    pub dem: &'a Dem,
    /// The package's grid.
    pub plan: &'a GridPlan,
}

/// Returns the same package with the vertical datum `dem_vertical_crs` ("EPSG:n"), if the package
/// does not know its own: as if it had been built with this `--dem-vertical-crs`. No height
/// changes.
///
/// # Errors
/// When the package knows its datum, or this is not a vertical CRS in metres upwards.
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

/// Returns the largest distance of a level from the elevation data at its samples, metres. The
/// stored bound applies to the nodes of the finest grid. If these are not samples, samples may be
/// farther off, and the largest measured distance counts.
pub(crate) fn sample_bound_m(manifest: &Manifest, level: u8) -> f64 {
    let record = manifest.levels.get(usize::from(level));
    record.map_or(0.0, |record| record.geometric_error_m.max(record.sample_error.max_m))
}

/// Returns this distance in a whole sentence; `None` if the package has no such level.
pub(crate) fn height_bound(manifest: &Manifest, level: u8) -> Option<String> {
    let _known = manifest.levels.get(usize::from(level))?;
    // Rounded up, but rounding errors do not add a centimetre.
    let bound_m = (sample_bound_m(manifest, level) * 100.0 - 1e-6).ceil() / 100.0;
    Some(format!("Heights are within {bound_m} m of the elevation data, at its samples."))
}

/// Returns this sentence for lines on the elevation files themselves, and on decks.
pub(crate) fn dem_heights(tolerance_m: f64, has_decks: bool) -> String {
    let tolerance_m = (tolerance_m * 1000.0 - 1e-6).ceil() / 1000.0;
    let decks = if has_decks { " Those of bridges and tunnels are estimates." } else { "" };
    format!("Heights are within {tolerance_m} m of the elevation data, over the whole line.{decks}")
}
