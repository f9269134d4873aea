//! Reads the extract and stores what tiles need of it.

pub mod kept;
mod no_road;
pub mod partition;
pub mod placed_reading;

use crate::ExtractError;

/// Returns the threads that read an extract.
///
/// # Errors
/// When the threads cannot be started.
pub fn reading_pool(threads: usize) -> Result<rayon::ThreadPool, ExtractError> {
    Ok(rayon::ThreadPoolBuilder::new().num_threads(threads).build()?)
}
