//! Messages for the user. Warnings stay until they are dismissed; other messages disappear after a
//! few seconds.

use std::{io, path::PathBuf};

use corniche_viewer::{
    RoadMethod,
    flight::FlightError,
    gpu::{Gpu, ReadBackError},
};

use crate::formatting::with_causes;

/// The largest number of messages.
const MOST: usize = 6;
/// A message that is not a warning disappears after this time.
const NEWS_S: f64 = 8.0;

/// A message.
#[derive(Debug, Clone, PartialEq)]
pub struct Notice {
    /// The text of the message. In a text of several lines, one line points at letters of another.
    pub words: String,
    /// The time at which the message disappears; `None` if it stays until it is dismissed.
    pub until_s: Option<f64>,
}

/// The reason why an image, a flight or a drawing was not saved.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum NotSaved {
    #[error("cannot save to {folder:?}")]
    File { folder: PathBuf, source: io::Error },
    #[error("nothing was recorded")]
    Recording(#[from] FlightError),
    #[error("no image was saved")]
    Picture(#[from] ReadBackError),
    #[error("no image was saved: the map was not drawn yet")]
    Untaken,
    #[error("no image was saved: the graphics device was lost")]
    DeviceLost,
}

/// The notices of a window. Times are seconds of one clock.
#[derive(Debug, Default)]
pub struct Notices(Vec<Notice>);

impl Notices {
    /// Adds a warning.
    pub fn warn(&mut self, words: String) {
        self.add(words, None);
    }

    /// Adds several warnings, or none.
    pub fn warn_all(&mut self, words: impl IntoIterator<Item = String>) {
        words.into_iter().for_each(|words| self.warn(words));
    }

    /// Adds a message that disappears after a few seconds.
    pub fn tell(&mut self, words: String, now_s: f64) {
        self.add(words, Some(now_s + NEWS_S));
    }

    /// Warns if the CPU draws. `roads` is the drawing method of roads, `asked` the method that a
    /// GPU would use.
    pub fn warn_of_software(&mut self, gpu: &Gpu, roads: RoadMethod, asked: RoadMethod) {
        if gpu.is_software() {
            let adapter = &gpu.adapter_name;
            let roads =
                if roads == asked { "" } else { ", and roads as geometry (GEO), which is faster" };
            self.warn(format!(
                "no GPU was found: the CPU draws ({adapter}), more coarsely while the camera moves{roads}"
            ));
        }
    }

    /// Reports whether a file was saved.
    pub fn tell_saved(&mut self, saved: Result<PathBuf, NotSaved>, now_s: f64) {
        match saved {
            Ok(path) => self.tell(format!("saved {}", path.display()), now_s),
            Err(lost) => self.warn(with_causes(&lost)),
        }
    }

    /// Adds a message. If there are too many, the oldest message that is not a warning is removed,
    /// or else the oldest warning.
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
    pub fn retract(&mut self, beginning: &str) {
        self.0.retain(|notice| !notice.words.starts_with(beginning));
    }

    /// Removes the message at this index, if there is one.
    pub fn dismiss(&mut self, place: usize) {
        if place < self.0.len() {
            self.0.remove(place);
        }
    }

    /// Removes expired messages.
    pub fn expire(&mut self, now_s: f64) {
        self.0.retain(|notice| notice.until_s.is_none_or(|until_s| now_s < until_s));
    }

    /// The time at which the next message disappears.
    #[must_use]
    pub fn next_end_s(&self) -> Option<f64> {
        self.0.iter().filter_map(|notice| notice.until_s).reduce(f64::min)
    }

    /// All messages, oldest first.
    #[must_use]
    pub fn all(&self) -> &[Notice] {
        &self.0
    }
}

#[cfg(test)]
#[path = "notices_tests.rs"]
mod tests;
