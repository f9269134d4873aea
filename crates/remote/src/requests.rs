//! Counts of the requests to a server and of the bytes that came.

use std::sync::atomic::{AtomicU64, Ordering};

/// What was asked of a server so far.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Requests {
    /// How many requests were sent, repetitions included. Redirections come on top.
    pub count: u64,
    /// Bytes of bodies received, without headers.
    pub received_bytes: u64,
}

/// Counts of one source.
#[derive(Debug, Default)]
pub(crate) struct Counter {
    count: AtomicU64,
    received_bytes: AtomicU64,
}

impl Counter {
    pub(crate) fn sent(&self) {
        self.count.fetch_add(1, Ordering::Relaxed);
    }

    pub(crate) fn received(&self, bytes: usize) {
        self.received_bytes.fetch_add(bytes as u64, Ordering::Relaxed);
    }

    pub(crate) fn so_far(&self) -> Requests {
        Requests {
            count: self.count.load(Ordering::Relaxed),
            received_bytes: self.received_bytes.load(Ordering::Relaxed),
        }
    }
}
