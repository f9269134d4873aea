//! Coordinate systems as files and options name them: a horizontal one, optionally with a vertical
//! one.

use gdal::errors::GdalError;
use gdal::spatial_ref::SpatialRef;

use crate::crs::horizontal::Crs;
use crate::crs::vertical::VerticalCrs;
use crate::crs::wkt::{bound_system, children, keyword, wkt2};
use crate::{CrsError, library_error};

/// A horizontal system, and the vertical one that is named with it.
pub(crate) type CrsParts = (Crs, Option<VerticalCrs>);

/// The systems of "EPSG:n" or WKT, as given with `option`.
///
/// # Errors
/// When PROJ does not know the system, or it is neither projected nor geographic.
pub fn crs_from_text(
    option: &'static str,
    text: &str,
) -> Result<(Crs, Option<VerticalCrs>), CrsError> {
    library_error::forget();
    let reference = SpatialRef::from_definition(text).map_err(|source| CrsError::Text {
        option,
        text: text.to_owned(),
        source: source.into(),
    })?;
    let kind = || CrsError::Kind { option, text: text.to_owned() };
    parts_of(&reference)?.ok_or_else(kind)
}

/// The horizontal part of a system and the vertical one, if any; `None` if the system is neither
/// projected nor geographic.
pub(crate) fn parts_of(reference: &SpatialRef) -> Result<Option<CrsParts>, CrsError> {
    let mut reference = reference.clone();
    let name = reference.name().unwrap_or_default();
    let as_wkt = |source: GdalError| CrsError::Wkt { name: name.clone(), source: source.into() };
    let wkt = wkt2(&reference).map_err(as_wkt)?;
    let vertical = VerticalCrs::of_wkt(&wkt)?;
    if reference.is_compound() {
        // The vertical system must be removed from the horizontal one: PROJ would need geoid grids.
        let Some(text) = children(&wkt).into_iter().find(|part| is_horizontal(part)) else {
            return Ok(None);
        };
        reference = SpatialRef::from_wkt(&text).map_err(as_wkt)?;
    }
    if !(reference.is_projected() || reference.is_geographic()) || reference.is_local() {
        return Ok(None);
    }
    Ok(Some((Crs::from_spatial_ref(&reference)?, vertical)))
}

/// Whether a part of a compound system is the horizontal one.
fn is_horizontal(wkt: &str) -> bool {
    if keyword(wkt) == "BOUNDCRS" {
        return bound_system(wkt).is_some_and(|inner| is_horizontal(&inner));
    }
    ["PROJ", "GEOG", "GEOD"].iter().any(|word| keyword(wkt).starts_with(word))
}

#[cfg(test)]
#[path = "crs_text_tests.rs"]
mod tests;
