//! Locks that tolerate panics of other threads.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// Locks a value that is consistent at any time, because it is assigned in one step. The lock works
/// even after another thread panicked while holding it.
pub fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
