//! A share of an extract, printed `I/N`, which one process reads while others read the rest.

use std::{fmt, ops::Range, str::FromStr};

/// One of so many shares of an extract, printed `I/N`: its number, counted from 1, and how many there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Share {
    of: u16,
    number: u16,
}

/// Why something is not a share.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "{text:?} is not a share I/N, such as 2/8, with I from 1 to N and N at most {}",
    Share::MOST
)]
pub struct ShareError {
    text: String,
}

impl Share {
    /// More shares than this are refused: while they are put together a little of each is in memory.
    pub const MOST: u16 = 256;
    /// The only one: all of the extract.
    pub const WHOLE: Self = Self { of: 1, number: 1 };

    /// `None` unless `number` is from 1 to `of`, and `of` at most [`Self::MOST`].
    #[must_use]
    pub const fn new(number: u16, of: u16) -> Option<Self> {
        if number >= 1 && number <= of && of <= Self::MOST {
            Some(Self { of, number })
        } else {
            None
        }
    }

    /// All shares of so many, in the order of the file.
    pub fn all(of: u16) -> impl Iterator<Item = Self> + Clone {
        (1..=of).filter_map(move |number| Self::new(number, of))
    }

    /// Which share it is, counted from 1.
    #[must_use]
    pub const fn number(self) -> u16 {
        self.number
    }

    /// How many there are.
    #[must_use]
    pub const fn of(self) -> u16 {
        self.of
    }

    /// Which of some things in a row are this share's, so that all shares have nearly the same size: those that begin in it.
    pub(crate) fn part_of(self, sizes: impl Iterator<Item = u64> + Clone) -> Range<usize> {
        let total: u64 = sizes.clone().sum();
        let of = u128::from(self.of);
        // Those of no size at the end begin behind everything, and belong to the last share.
        let share_of = |before: u64| {
            ((u128::from(before) * of / u128::from(total.max(1))) as u16).min(self.of - 1)
        };
        let (mut before, mut range) = (0, 0..0);
        for size in sizes {
            let share = share_of(before);
            if share + 1 < self.number {
                range.start += 1;
            }
            if share < self.number {
                range.end += 1;
            }
            before += size;
        }
        range
    }
}

impl fmt::Display for Share {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl FromStr for Share {
    type Err = ShareError;

    fn from_str(text: &str) -> Result<Self, ShareError> {
        let share = text
            .split_once('/')
            .and_then(|(number, of)| Self::new(number.parse().ok()?, of.parse().ok()?));
        share.ok_or_else(|| ShareError { text: text.to_owned() })
    }
}

#[cfg(test)]
#[path = "share_tests.rs"]
mod tests;
