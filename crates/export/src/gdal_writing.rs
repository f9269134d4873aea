//! Inputs of GDAL's writers: settings for one thread that are reset when they are dropped, and
//! plain texts.

use std::{borrow::Cow, path::Path};

use gdal::{
    Dataset,
    config::{clear_thread_local_config_option, set_thread_local_config_option},
    errors::GdalError,
    spatial_ref::{AxisMappingStrategy, SpatialRef},
};

use crate::error::GdalFileError;

/// Settings of GDAL for the current thread, until this value is dropped.
pub(crate) struct GdalSettings(&'static [(&'static str, &'static str)]);

impl GdalSettings {
    pub(crate) fn set(settings: &'static [(&'static str, &'static str)]) -> Self {
        corniche_gis::quiet();
        corniche_gis::forget();
        for (key, value) in settings {
            // Both are plain texts. This fails only for texts with a zero byte.
            let _ = set_thread_local_config_option(key, value);
        }
        Self(settings)
    }
}

impl Drop for GdalSettings {
    fn drop(&mut self) {
        for (key, _) in self.0 {
            let _ = clear_thread_local_config_option(key);
        }
    }
}

/// A CRS with the axis order east, north that files use, whatever its authority defines.
pub(crate) fn east_north(definition: &str) -> Result<SpatialRef, GdalError> {
    let mut crs = SpatialRef::from_definition(definition)?;
    crs.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
    Ok(crs)
}

/// Closes a file. Before GDAL 3.7, no call returns the errors of closing.
pub(crate) fn close(dataset: Dataset, path: &Path) -> Result<(), GdalFileError> {
    corniche_gis::forget();
    dataset.close().map_err(|error| GdalFileError::write(path, error))?;
    corniche_gis::failure().map_or(Ok(()), |source| Err(GdalFileError::write(path, source)))
}

/// Returns a text about a whole file without NUL, which ends texts in C, and without the other
/// control characters, which XML (in which some formats store these texts) does not allow.
pub(crate) fn plain_text(text: &str) -> Cow<'_, str> {
    if text.contains(char::is_control) {
        return Cow::Owned(text.replace(char::is_control, " "));
    }
    Cow::Borrowed(text)
}

#[cfg(test)]
#[path = "gdal_writing_tests.rs"]
mod tests;
