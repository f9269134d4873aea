//! What GDAL's writers are given: settings that hold for one thread until they are dropped, and
//! plain texts.

use std::borrow::Cow;

use gdal::config::{clear_thread_local_config_option, set_thread_local_config_option};

/// Settings of GDAL, of this thread alone, until it is dropped.
pub(crate) struct GdalSettings(&'static [(&'static str, &'static str)]);

impl GdalSettings {
    pub(crate) fn set(settings: &'static [(&'static str, &'static str)]) -> Self {
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
