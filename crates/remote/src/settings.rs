//! How long requests wait and how often they are tried again.

use std::time::Duration;

/// How patient requests are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HttpSettings {
    /// The most tries after the first one, of a request that failed for a moment.
    pub retries: u32,
    /// The pause before the first of them; each later one is twice as long.
    pub first_pause: Duration,
    /// The longest time that a server may ask for (`Retry-After`). One that asks for more is not waited for.
    pub longest_pause: Duration,
    /// Time to connect.
    pub connect_timeout: Duration,
    /// Time without a byte, while an answer is awaited or read.
    pub idle_timeout: Duration,
    /// The least bytes a second, on average over an answer: what is slower ends, however often a byte comes.
    pub least_bytes_per_second: u64,
}

impl HttpSettings {
    /// The longest time of a request for so many bytes: twice that of a pause, for the head and for a pause on the way, and what the bytes take.
    pub(crate) fn longest(&self, bytes: u64) -> Duration {
        let share = bytes as f64 / self.least_bytes_per_second.max(1) as f64;
        self.idle_timeout * 2 + Duration::from_secs_f64(share)
    }
}

impl Default for HttpSettings {
    /// Pauses of 6 seconds in all, unless the server asks for more.
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
