//! What heights of a package are: the elevation files that it was made from, what they are measured
//! from, and how far heights may be from them, in words.

use corniche_dem::{Dem, GridPlan};
use corniche_gis::RecordedHeights;
use corniche_tileset::{FilePackage, Manifest, VerticalRecord};

use crate::error::DatumError;

/// The elevation files that a package was made from.
#[derive(Debug, Clone, Copy)]
pub struct Elevation<'a> {
    /// Opened as the build did.
    pub dem: &'a Dem,
    /// The package's grid.
    pub plan: &'a GridPlan,
}

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

/// How far a level is from the elevation data at its samples, at most, metres. The stored bound holds at the nodes of the finest grid. Where these
/// are no samples, samples may be farther off, and the largest distance that was measured counts.
pub(crate) fn sample_bound_m(manifest: &Manifest, level: u8) -> f64 {
    let record = manifest.levels.get(usize::from(level));
    record.map_or(0.0, |record| record.geometric_error_m.max(record.sample_error.max_m))
}

/// The same as a whole sentence; `None` where the package has no such level.
pub(crate) fn height_bound(manifest: &Manifest, level: u8) -> Option<String> {
    let _known = manifest.levels.get(usize::from(level))?;
    // Never less than it is, but not a centimetre more for rounding.
    let bound_m = (sample_bound_m(manifest, level) * 100.0 - 1e-6).ceil() / 100.0;
    Some(format!("Heights are within {bound_m} m of the elevation data, at its samples."))
}

/// The same of lines on the elevation files themselves, and on decks.
pub(crate) fn dem_heights(tolerance_m: f64, has_decks: bool) -> String {
    let tolerance_m = (tolerance_m * 1000.0 - 1e-6).ceil() / 1000.0;
    let decks = if has_decks { " Those of bridges and tunnels are estimates." } else { "" };
    format!("Heights are within {tolerance_m} m of the elevation data, over the whole line.{decks}")
}
