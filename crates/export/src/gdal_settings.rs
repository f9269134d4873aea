//! Settings of GDAL that hold for one thread until they are dropped.

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
