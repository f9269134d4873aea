//! Messages for the person. Warnings stay until they are dismissed; other messages disappear after a few seconds.

use std::{io, path::PathBuf};

use corniche_viewer::{
    RoadMethod,
    flight::FlightError,
    gpu::{Gpu, ReadBackError},
};

use crate::formatting::with_causes;

/// Most messages that are kept.
const MOST: usize = 6;
/// A message that is no warning disappears after this time.
const NEWS_S: f64 = 8.0;

/// A message.
#[derive(Debug, Clone, PartialEq)]
pub struct Notice {
    /// Its text. In a text of several lines, one line points at letters of another.
    pub words: String,
    /// When it disappears; `None` if it stays until it is dismissed.
    pub until_s: Option<f64>,
}

/// Why a picture, a flight or a drawing was not saved.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum NotSaved {
    #[error("nothing could be saved in {}", folder.display())]
    File { folder: PathBuf, source: io::Error },
    #[error("nothing was recorded")]
    Recording(#[from] FlightError),
    #[error("no picture was taken")]
    Picture(#[from] ReadBackError),
    #[error("no picture was taken: it was not yet drawn")]
    Untaken,
    #[error("no picture was taken: the graphics device was lost")]
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

    /// Warns where the processor draws. `roads` is how roads are drawn, `asked` how they would be
    /// drawn by a graphics card.
    pub fn warn_of_software(&mut self, gpu: &Gpu, roads: RoadMethod, asked: RoadMethod) {
        if gpu.is_software() {
            let adapter = &gpu.adapter_name;
            let roads = if roads == asked {
                ""
            } else {
                ", and roads as geometry (GEO), which takes less time"
            };
            self.warn(format!(
                "no graphics card was found: the processor draws ({adapter}), more coarsely while the camera moves{roads}"
            ));
        }
    }

    /// Tells what became of a file that was to be saved.
    pub fn tell_saved(&mut self, saved: Result<PathBuf, NotSaved>, now_s: f64) {
        match saved {
            Ok(path) => self.tell(format!("saved {}", path.display()), now_s),
            Err(lost) => self.warn(with_causes(&lost)),
        }
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
    pub fn retract(&mut self, beginning: &str) {
        self.0.retain(|notice| !notice.words.starts_with(beginning));
    }

    /// Removes the message at this place, if there is one.
    pub fn dismiss(&mut self, place: usize) {
        if place < self.0.len() {
            self.0.remove(place);
        }
    }

    /// Removes the messages whose time is over.
    pub fn expire(&mut self, now_s: f64) {
        self.0.retain(|notice| notice.until_s.is_none_or(|until_s| now_s < until_s));
    }

    /// When the next message disappears.
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
