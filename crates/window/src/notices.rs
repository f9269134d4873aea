//! What happened, as the person reads it: warnings stay until they are dismissed, good news goes by itself.

/// More of them than these are not kept.
const MOST: usize = 6;
/// Good news stays for so long.
const NEWS_S: f64 = 8.0;

/// What happened.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Notice {
    /// In words; where they have several lines, one line points at letters of another.
    pub(crate) words: String,
    /// When it goes by itself; `None` where it stays until it is dismissed.
    pub(crate) until_s: Option<f64>,
}

/// The notices of a window. Times are seconds of one clock.
#[derive(Debug, Default)]
pub(crate) struct Notices(Vec<Notice>);

impl Notices {
    /// Says something that stays.
    pub(crate) fn warn(&mut self, words: String) {
        self.add(words, None);
    }

    /// Says several things, if there are any, that stay.
    pub(crate) fn warn_all(&mut self, words: impl IntoIterator<Item = String>) {
        words.into_iter().for_each(|words| self.warn(words));
    }

    /// Says something that goes by itself.
    pub(crate) fn tell(&mut self, words: String, now_s: f64) {
        self.add(words, Some(now_s + NEWS_S));
    }

    /// Where there are too many, the oldest good news goes before any warning.
    fn add(&mut self, mut words: String, until_s: Option<f64>) {
        words.truncate(words.trim_end().len());
        // The same thing again is no news.
        self.0.retain(|known| known.words != words);
        self.0.push(Notice { words, until_s });
        while self.0.len() > MOST {
            let oldest = self.0.iter().position(|notice| notice.until_s.is_some()).unwrap_or(0);
            self.0.remove(oldest);
        }
    }

    /// Forgets those that begin so: what they say is true no more.
    pub(crate) fn retract(&mut self, beginning: &str) {
        self.0.retain(|notice| !notice.words.starts_with(beginning));
    }

    /// Forgets the one at this place, if there is one.
    pub(crate) fn dismiss(&mut self, place: usize) {
        if place < self.0.len() {
            self.0.remove(place);
        }
    }

    /// Forgets those whose time is over.
    pub(crate) fn expire(&mut self, now_s: f64) {
        self.0.retain(|notice| notice.until_s.is_none_or(|until_s| now_s < until_s));
    }

    /// When the next one goes by itself.
    pub(crate) fn next_end_s(&self) -> Option<f64> {
        self.0.iter().filter_map(|notice| notice.until_s).reduce(f64::min)
    }

    /// Oldest first.
    pub(crate) fn all(&self) -> &[Notice] {
        &self.0
    }
}

#[cfg(test)]
#[path = "notices_tests.rs"]
mod tests;
