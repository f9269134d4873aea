//! How the memory that a run may use is shared out.

use crate::{Resources, inputs::InputError};

/// Shares of `--memory`, bytes. What is left serves the program itself and what threads work on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MemoryShares {
    /// GDAL's cache of raster blocks, for all threads.
    pub(crate) raster_cache: u64,
    /// Grounds of coarse tiles, for all threads.
    pub grounds: u64,
    /// Sorting of roads.
    pub sorting: u64,
    /// Blocks of objects, where stores are in object storage.
    pub blocks: u64,
}

impl MemoryShares {
    /// The shares of so many bytes.
    #[must_use]
    pub fn of(memory_bytes: u64) -> Self {
        Self {
            raster_cache: memory_bytes / 8,
            grounds: memory_bytes / 8,
            sorting: memory_bytes / 4,
            blocks: memory_bytes / 16,
        }
    }

    /// Gives GDAL its share. To be called before the first raster is opened.
    ///
    /// # Errors
    /// See [`InputError`].
    pub fn limit_raster_cache(resources: Resources) -> Result<(), InputError> {
        corniche_gis::limit_block_cache(Self::of(resources.memory_bytes).raster_cache)
            .map_err(|error| InputError::Setting { what: error.to_string() })
    }
}
