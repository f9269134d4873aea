//! Timeouts and retries of requests.

use std::time::Duration;

/// The timeouts and retries of requests.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HttpSettings {
    /// The largest number of retries of a request that failed temporarily.
    pub retries: u32,
    /// The pause before the first retry; each later pause is twice as long.
    pub first_pause: Duration,
    /// The longest accepted `Retry-After`. A server that requests a longer pause is not waited for.
    pub longest_pause: Duration,
    /// The time limit for connecting.
    pub connect_timeout: Duration,
    /// The time limit without a byte, before and during an answer.
    pub idle_timeout: Duration,
    /// The lowest average transfer rate of an answer, in bytes per second: a slower answer is
    /// ended, even if bytes keep arriving.
    pub least_bytes_per_second: u64,
}

impl HttpSettings {
    /// The time limit of a request for this many bytes: twice `idle_timeout`, for the head
    /// and for one pause in between, plus the time for the bytes.
    pub(crate) fn longest(&self, bytes: u64) -> Duration {
        let share = bytes as f64 / self.least_bytes_per_second.max(1) as f64;
        self.idle_timeout * 2 + Duration::from_secs_f64(share)
    }
}

impl Default for HttpSettings {
    /// Pauses of 6 seconds in all, unless the server requests more.
    fn default() -> Self {
        Self {
            retries: 5,
            first_pause: Duration::from_millis(200),
            longest_pause: Duration::from_mins(1),
            connect_timeout: Duration::from_secs(10),
            idle_timeout: Duration::from_secs(30),
            least_bytes_per_second: 4096,
        }
    }
}
