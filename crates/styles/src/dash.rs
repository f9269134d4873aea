use crate::StyleError;

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
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dash {
    /// Where the first dash, the first gap and the second dash end, as shares of the pattern.
    ends: [f32; 3],
    /// Least length of the pattern on the picture; 0 for a solid line.
    least_px: f32,
}

impl Dash {
    /// No gaps.
    pub const SOLID: Self = Self { ends: [1.0; 3], least_px: 0.0 };

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
        Ok(Self { ends, least_px: sum })
    }

    /// Where the first dash, the first gap and the second dash end, as shares of the pattern.
    #[must_use]
    pub const fn ends(&self) -> [f32; 3] {
        self.ends
    }

    /// Least length of the pattern on the picture; 0 for a solid line.
    #[must_use]
    pub const fn least_px(&self) -> f32 {
        self.least_px
    }
}

#[cfg(test)]
#[path = "dash_tests.rs"]
mod tests;
