//! Locks of what is whole at any time.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// Locks what is whole also after a thread ended in the middle of its work: it is set at once.
pub fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
