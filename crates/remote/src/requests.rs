//! Counts of the requests to a server and of the bytes received.

/// The traffic of a server so far.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ServerRequests {
    /// The number of requests, retries included. Redirections are not included.
    pub count: u64,
    /// Bytes of bodies received, without headers.
    pub received_bytes: u64,
}
