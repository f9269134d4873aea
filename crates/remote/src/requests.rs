//! Counts of the requests to a server and of the bytes received.

use std::sync::atomic::{AtomicU64, Ordering};

/// The traffic of a server so far.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ServerRequests {
    /// The number of requests, retries included. Redirections are not included.
    pub count: u64,
    /// Bytes of bodies received, without headers.
    pub received_bytes: u64,
}

/// Counts of one source.
#[derive(Debug, Default)]
pub(crate) struct RequestCounter {
    count: AtomicU64,
    received_bytes: AtomicU64,
}

impl RequestCounter {
    pub(crate) fn sent(&self) {
        self.count.fetch_add(1, Ordering::Relaxed);
    }

    pub(crate) fn received(&self, bytes: usize) {
        self.received_bytes.fetch_add(bytes as u64, Ordering::Relaxed);
    }

    pub(crate) fn so_far(&self) -> ServerRequests {
        ServerRequests {
            count: self.count.load(Ordering::Relaxed),
            received_bytes: self.received_bytes.load(Ordering::Relaxed),
        }
    }
}
