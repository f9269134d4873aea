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
        }
    }
}
