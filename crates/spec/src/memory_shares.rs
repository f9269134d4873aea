//! The distribution of a run's memory among its parts.

use crate::{Resources, inputs::InputError};

/// Shares of `--memory`, bytes. The rest serves the program itself and the work of threads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MemoryShares {
    /// GDAL's cache of raster blocks, for all threads.
    pub(crate) raster_cache: u64,
    /// Ground of coarse tiles, for all threads.
    pub grounds: u64,
    /// Sorting of roads.
    pub sorting: u64,
    /// Blocks of objects, if stores are in object storage.
    pub blocks: u64,
}

impl MemoryShares {
    /// Divides this many bytes into shares.
    #[must_use]
    pub fn from_memory(memory_bytes: u64) -> Self {
        Self {
            raster_cache: memory_bytes / 8,
            grounds: memory_bytes / 8,
            sorting: memory_bytes / 4,
            blocks: memory_bytes / 16,
        }
    }

    /// Sets the size of GDAL's cache. Call it before the first raster is opened.
    ///
    /// # Errors
    /// See [`InputError`].
    pub fn limit_raster_cache(resources: Resources) -> Result<(), InputError> {
        corniche_gis::limit_block_cache(Self::from_memory(resources.memory_bytes).raster_cache)
            .map_err(|error| InputError::Setting { what: error.to_string() })
    }
}
