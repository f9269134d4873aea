//! Patterns along a line: dashes, dots, beads and arrows, with the width of each part.

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
/// Dashes lie on the ground: their lengths are true lengths along it, uphill too. From farther away they get longer, by a factor of
/// two each time, so that on the picture a pattern has at least the length asked for, and less than twice that.
///
/// A pattern may also say how wide the line is along it, as a texture with one row: [`Dash::textured`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Dash {
    /// Where the first dash, the first gap and the second dash end, as shares of the pattern.
    pub ends: [f32; 3],
    /// Least length of the pattern on the picture; 0 for a solid line.
    pub least_px: f32,
    /// How wide the line is along the pattern; `None`: everywhere as wide.
    pub widths: Option<[f32; Dash::WIDTHS]>,
}

impl Dash {
    /// No gaps.
    pub const SOLID: Self = Self { ends: [1.0; 3], least_px: 0.0, widths: None };

    /// How many widths a pattern has along it.
    pub const WIDTHS: usize = 16;

    /// The longest dash or gap, pixels.
    pub const LONGEST_PX: f32 = 200.0;

    /// Dash, gap, and, if wanted, another dash and gap, in pixels of the picture; without any, a solid line.
    ///
    /// # Errors
    /// When there are one, three or more than four lengths, or one is not between 1 and [`Dash::LONGEST_PX`].
    pub fn new(lengths_px: &[f32]) -> Result<Self, StyleError> {
        let pattern = match *lengths_px {
            [] => return Ok(Self::SOLID),
            // The same dash and gap twice.
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

    /// A pattern of this length in pixels of the picture that says how wide the line is along it: 1 to [`Dash::WIDTHS`] shares of its width,
    /// at equal distances; between them it changes evenly, and where it is 0 there is a gap. From farther away, where patterns get longer,
    /// these shapes keep their length, and what is at their end goes on up to the next one.
    ///
    /// # Errors
    /// When there are none or too many shares, one is not between 0 and 1, or the length is not between 2 and four times
    /// [`Dash::LONGEST_PX`].
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
            // The middle of one of equal pieces of the pattern, between the middles of the shares' pieces.
            let at = (place as f32 + 0.5) / Self::WIDTHS as f32 * shares.len() as f32 - 0.5;
            let at = at.clamp(0.0, last as f32);
            let before = at.floor() as usize;
            let (low, high) = (shares[before], shares[(before + 1).min(last)]);
            low + (high - low) * (at - before as f32)
        };
        let widths = std::array::from_fn(width);
        Ok(Self { ends: [1.0; 3], least_px: length_px, widths: Some(widths) })
    }

    /// A pattern of dots, round where the line's width is half the pattern's length.
    ///
    /// # Errors
    /// As [`Dash::textured`].
    pub fn dots(length_px: f32) -> Result<Self, StyleError> {
        Self::textured(length_px, &Self::dot(0.0))
    }

    /// A pattern of dots on a line a quarter as wide.
    ///
    /// # Errors
    /// As [`Dash::textured`].
    pub fn beads(length_px: f32) -> Result<Self, StyleError> {
        Self::textured(length_px, &Self::dot(0.25))
    }

    /// A pattern of arrow heads that point along the line, with gaps.
    ///
    /// # Errors
    /// As [`Dash::textured`].
    pub fn arrows(length_px: f32) -> Result<Self, StyleError> {
        let head: [f32; Self::WIDTHS] = std::array::from_fn(|place| match place {
            1..=10 => 1.0 - (place as f32 - 1.0) / 10.0,
            // The first one, too, so that heads have straight backs.
            _ => 0.0,
        });
        Self::textured(length_px, &head)
    }

    /// A dot over about half of the pattern, at least so wide. What is beside it is the same on both sides.
    fn dot(least: f32) -> [f32; Self::WIDTHS] {
        let half = Self::WIDTHS as f32 / 4.0;
        std::array::from_fn(|place| {
            // The first place lies before the dot.
            let from_middle = (place as f32 - 0.5 - half) / half;
            (1.0 - from_middle * from_middle).max(0.0).sqrt().max(least)
        })
    }

    /// How wide a line is so far along it on the picture, as a share of its width, where its pattern is as short as it gets.
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
