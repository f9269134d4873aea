//! Messages for the person. Warnings stay until they are dismissed; other messages disappear after a few seconds.

/// Most messages that are kept.
const MOST: usize = 6;
/// A message that is no warning disappears after this time.
const NEWS_S: f64 = 8.0;

/// A message.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Notice {
    /// Its text. In a text of several lines, one line points at letters of another.
    pub(crate) words: String,
    /// When it disappears; `None` if it stays until it is dismissed.
    pub(crate) until_s: Option<f64>,
}

/// The notices of a window. Times are seconds of one clock.
#[derive(Debug, Default)]
pub(crate) struct Notices(Vec<Notice>);

impl Notices {
    /// Adds a warning.
    pub(crate) fn warn(&mut self, words: String) {
        self.add(words, None);
    }

    /// Adds several warnings, or none.
    pub(crate) fn warn_all(&mut self, words: impl IntoIterator<Item = String>) {
        words.into_iter().for_each(|words| self.warn(words));
    }

    /// Adds a message that disappears after a few seconds.
    pub(crate) fn tell(&mut self, words: String, now_s: f64) {
        self.add(words, Some(now_s + NEWS_S));
    }

    /// Adds a message. Where there are too many, the oldest that is no warning is removed, or else the oldest warning.
    fn add(&mut self, mut words: String, until_s: Option<f64>) {
        words.truncate(words.trim_end().len());
        // The same message is shown once, as the newest.
        self.0.retain(|known| known.words != words);
        self.0.push(Notice { words, until_s });
        while self.0.len() > MOST {
            let oldest = self.0.iter().position(|notice| notice.until_s.is_some()).unwrap_or(0);
            self.0.remove(oldest);
        }
    }

    /// Removes the messages that begin with `beginning`, because they are no longer true.
    pub(crate) fn retract(&mut self, beginning: &str) {
        self.0.retain(|notice| !notice.words.starts_with(beginning));
    }

    /// Removes the message at this place, if there is one.
    pub(crate) fn dismiss(&mut self, place: usize) {
        if place < self.0.len() {
            self.0.remove(place);
        }
    }

    /// Removes the messages whose time is over.
    pub(crate) fn expire(&mut self, now_s: f64) {
        self.0.retain(|notice| notice.until_s.is_none_or(|until_s| now_s < until_s));
    }

    /// When the next message disappears.
    pub(crate) fn next_end_s(&self) -> Option<f64> {
        self.0.iter().filter_map(|notice| notice.until_s).reduce(f64::min)
    }

    /// All messages, oldest first.
    pub(crate) fn all(&self) -> &[Notice] {
        &self.0
    }
}

#[cfg(test)]
#[path = "notices_tests.rs"]
mod tests;
