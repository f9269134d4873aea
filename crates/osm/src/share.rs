//! A share of an extract, printed as `I/N`, which one process reads while others read the rest.

use std::{fmt, ops::Range, str::FromStr};

/// One of several shares of an extract, printed as `I/N`: its number, counted from 1, and the
/// number of shares.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Share {
    of: u16,
    number: u16,
}

/// The reason why a text is not a share.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "{text:?} is not a chunk I/N, such as 2/8, with I from 1 to N and N at most {}",
    Share::MOST
)]
pub struct ShareError {
    text: String,
}

impl Share {
    /// The maximum number of shares. While shares are merged, a little of each is in memory.
    pub const MOST: u16 = 256;
    /// The only share of an extract that is not split.
    pub const WHOLE: Self = Self { of: 1, number: 1 };

    /// Creates a share; `None` unless `number` is from 1 to `of`, and `of` is at most
    /// [`Self::MOST`].
    #[must_use]
    pub const fn new(number: u16, of: u16) -> Option<Self> {
        if number >= 1 && number <= of && of <= Self::MOST {
            Some(Self { of, number })
        } else {
            None
        }
    }

    /// Returns all shares of an extract that is split into `of`, in the order of the file.
    pub fn all(of: u16) -> impl Iterator<Item = Self> + Clone {
        (1..=of).filter_map(move |number| Self::new(number, of))
    }

    /// Returns the number of the share, counted from 1.
    #[must_use]
    pub const fn number(self) -> u16 {
        self.number
    }

    /// Returns the number of shares.
    #[must_use]
    pub const fn count(self) -> u16 {
        self.of
    }

    /// Returns the range of this share in a sequence of items, so that all shares have nearly the
    /// same size. An item belongs to the share in which it begins.
    pub(crate) fn part_of(self, sizes: impl Iterator<Item = u64> + Clone) -> Range<usize> {
        let total: u64 = sizes.clone().sum();
        let of = u128::from(self.of);
        // Items of size 0 at the end begin behind everything, and belong to the last share.
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
