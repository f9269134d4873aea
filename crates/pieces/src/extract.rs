//! What is read of the extract, and kept for tiles.

pub mod kept;
mod no_road;
pub mod partition;
pub mod placed_reading;

use crate::ExtractError;

/// Threads for the reading of an extract.
///
/// # Errors
/// When the threads cannot be started.
pub fn reading_pool(threads: usize) -> Result<rayon::ThreadPool, ExtractError> {
    Ok(rayon::ThreadPoolBuilder::new().num_threads(threads).build()?)
}
