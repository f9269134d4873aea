//! Patterns along a line: dashes, dots, beads and arrows, with the line's width along the pattern.

use crate::StyleError;
use serde::{Deserialize, Serialize};

/// A pattern of dashes and gaps that repeats along a line.
///
/// ```text
///   ├────────── one pattern ─────────┤
///   ██████████████      ████          ██████████████      ████
///     dash         gap  dash    gap
/// ```
///
/// Dashes are measured on the ground: their lengths are true lengths along it, uphill too. Farther
/// from the eye they double in length, again and again, so that on the picture a pattern is at
/// least as long as requested, and less than twice as long.
///
/// A pattern can also set the width of the line along it, like a texture with one row:
/// [`Dash::textured`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Dash {
    /// Where the first dash, the first gap and the second dash end, as shares of the pattern.
    pub ends: [f32; 3],
    /// Minimum length of the pattern on the picture; 0 for a solid line.
    pub least_px: f32,
    /// The widths of the line along the pattern; `None`: the width is constant.
    pub widths: Option<[f32; Dash::WIDTHS]>,
}

impl Dash {
    /// A solid line.
    pub const SOLID: Self = Self { ends: [1.0; 3], least_px: 0.0, widths: None };

    /// How many widths a pattern stores.
    pub const WIDTHS: usize = 16;

    /// The maximum length of a dash or gap, pixels.
    pub const LONGEST_PX: f32 = 200.0;

    /// Creates a pattern from the lengths of a dash and a gap, optionally followed by a second dash
    /// and gap, in pixels of the picture. An empty list gives a solid line.
    ///
    /// # Errors
    /// When there are one, three or more than four lengths, or a length is not between 1 and
    /// [`Dash::LONGEST_PX`].
    pub fn new(lengths_px: &[f32]) -> Result<Self, StyleError> {
        let pattern = match *lengths_px {
            [] => return Ok(Self::SOLID),
            // The same dash and gap repeated.
            [dash, gap] => [dash, gap, dash, gap],
            [dash, gap, second, last] => [dash, gap, second, last],
            _ => return Err(StyleError::DashCount { count: lengths_px.len() }),
        };
        if let Some(value) = pattern.iter().find(|px| !(1.0..=Self::LONGEST_PX).contains(*px)) {
            return Err(StyleError::DashLength { value: *value, most: Self::LONGEST_PX });
        }
        let sum: f32 = pattern.iter().sum();
        let mut reached = 0.0;
        let ends = [pattern[0], pattern[1], pattern[2]].map(|part| {
            reached += part / sum;
            reached
        });
        Ok(Self { ends, least_px: sum, widths: None })
    }

    /// Creates a pattern that varies the width of the line. `length_px` is its length in pixels of
    /// the picture; `shares` are 1 to [`Dash::WIDTHS`] shares of the line's width at equal
    /// distances. Between them the width changes linearly; where it is 0 there is a gap. Farther
    /// from the eye, where patterns get longer, these shapes keep their length, and the last width
    /// continues up to the next pattern.
    ///
    /// # Errors
    /// When there are none or too many shares, one is not between 0 and 1, or the length is not
    /// between 2 and four times [`Dash::LONGEST_PX`].
    pub fn textured(length_px: f32, shares: &[f32]) -> Result<Self, StyleError> {
        if shares.is_empty() || shares.len() > Self::WIDTHS {
            return Err(StyleError::PatternCount { count: shares.len(), most: Self::WIDTHS });
        }
        if let Some(value) = shares.iter().find(|share| !(0.0..=1.0).contains(*share)) {
            return Err(StyleError::PatternShare { value: *value });
        }
        let most = 4.0 * Self::LONGEST_PX;
        if !(2.0..=most).contains(&length_px) {
            return Err(StyleError::PatternLength { value: length_px, most });
        }
        let last = shares.len() - 1;
        let width = |place: usize| {
            // The middle of one of equal pieces of the pattern, relative to the middles of the
            // pieces of `shares`.
            let at = (place as f32 + 0.5) / Self::WIDTHS as f32 * shares.len() as f32 - 0.5;
            let at = at.clamp(0.0, last as f32);
            let before = at.floor() as usize;
            let (low, high) = (shares[before], shares[(before + 1).min(last)]);
            low + (high - low) * (at - before as f32)
        };
        let widths = std::array::from_fn(width);
        Ok(Self { ends: [1.0; 3], least_px: length_px, widths: Some(widths) })
    }

    /// A pattern of dots. They are round if the line's width is half the pattern's length.
    ///
    /// # Errors
    /// Same as [`Dash::textured`].
    pub fn dots(length_px: f32) -> Result<Self, StyleError> {
        Self::textured(length_px, &Self::dot(0.0))
    }

    /// A pattern of dots on a line that is a quarter as wide.
    ///
    /// # Errors
    /// Same as [`Dash::textured`].
    pub fn beads(length_px: f32) -> Result<Self, StyleError> {
        Self::textured(length_px, &Self::dot(0.25))
    }

    /// A pattern of arrow heads that point along the line, with gaps.
    ///
    /// # Errors
    /// Same as [`Dash::textured`].
    pub fn arrows(length_px: f32) -> Result<Self, StyleError> {
        let head: [f32; Self::WIDTHS] = std::array::from_fn(|place| match place {
            1..=10 => 1.0 - (place as f32 - 1.0) / 10.0,
            // The first width is 0, too, so that arrow heads have straight backs.
            _ => 0.0,
        });
        Self::textured(length_px, &head)
    }

    /// Returns a dot over about half of the pattern, on a line of width `least`. The pattern is
    /// symmetric about the dot.
    fn dot(least: f32) -> [f32; Self::WIDTHS] {
        let half = Self::WIDTHS as f32 / 4.0;
        std::array::from_fn(|place| {
            // The first width is before the dot.
            let from_middle = (place as f32 - 0.5 - half) / half;
            (1.0 - from_middle * from_middle).max(0.0).sqrt().max(least)
        })
    }

    /// The width of a line at `along_px` on the picture, as a share of its full width, for the
    /// shortest pattern.
    #[must_use]
    pub fn width_at(&self, along_px: f32) -> f32 {
        if self.least_px <= 0.0 {
            return 1.0;
        }
        let at = (along_px / self.least_px).rem_euclid(1.0);
        if let Some(widths) = self.widths {
            return widths[((at * Self::WIDTHS as f32) as usize).min(Self::WIDTHS - 1)];
        }
        let [dash, gap, second] = self.ends;
        f32::from(u8::from(at < dash || (gap..second).contains(&at)))
    }
}

#[cfg(test)]
#[path = "dash_tests.rs"]
mod tests;
