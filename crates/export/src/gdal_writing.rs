//! What GDAL's writers are given: settings that hold for one thread until they are dropped, and
//! plain texts.

use std::{borrow::Cow, path::Path};

use gdal::{
    Dataset,
    config::{clear_thread_local_config_option, set_thread_local_config_option},
    errors::GdalError,
    spatial_ref::{AxisMappingStrategy, SpatialRef},
};

use crate::error::GdalFileError;

/// Settings of GDAL, of this thread alone, until it is dropped.
pub(crate) struct GdalSettings(&'static [(&'static str, &'static str)]);

impl GdalSettings {
    pub(crate) fn set(settings: &'static [(&'static str, &'static str)]) -> Self {
        corniche_gis::quiet();
        corniche_gis::forget();
        for (key, value) in settings {
            // Both are plain texts: this fails for texts with a zero byte alone.
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

/// A system whose axes are east and north, as in files, whatever its authority says.
pub(crate) fn east_north(definition: &str) -> Result<SpatialRef, GdalError> {
    let mut crs = SpatialRef::from_definition(definition)?;
    crs.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
    Ok(crs)
}

/// Closes a file. What fails then comes back from no call before GDAL 3.7.
pub(crate) fn close(dataset: Dataset, path: &Path) -> Result<(), GdalFileError> {
    corniche_gis::forget();
    dataset.close().map_err(|error| GdalFileError::write(path, error))?;
    corniche_gis::failure().map_or(Ok(()), |source| Err(GdalFileError::write(path, source)))
}

/// A text about a whole file: C's texts end at a NUL, and XML, which some formats keep such texts as, has no control characters.
pub(crate) fn plain_text(text: &str) -> Cow<'_, str> {
    if text.contains(char::is_control) {
        return Cow::Owned(text.replace(char::is_control, " "));
    }
    Cow::Borrowed(text)
}

/// A value of a feature. What cannot be in a text of C is replaced as what is no UTF-8 is.
pub(crate) fn without_nul(text: &str) -> Cow<'_, str> {
    if text.contains('\0') {
        return Cow::Owned(text.replace('\0', "\u{fffd}"));
    }
    Cow::Borrowed(text)
}

#[cfg(test)]
#[path = "gdal_writing_tests.rs"]
mod tests;
