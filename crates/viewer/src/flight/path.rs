//! The path of a flight: smooth curves through its keyframes that never overshoot.

use super::{FlightError, Keyframe, Pose, keyframe::KEYFRAMES};
use crate::camera::Orientation;

/// Times, positions, heights and headings above this are mistakes.
const MOST: f64 = 1e9;

/// A path of the camera. Times ascend, and every number is finite and within its range.
#[derive(Debug, Clone, PartialEq)]
pub struct Flight {
    times_s: Vec<f64>,
    /// x, y, height, heading (without jumps: 350° is followed by 370°) and pitch.
    values: Vec<[f64; 5]>,
    /// The derivatives of `values` with respect to time.
    slopes: Vec<[f64; 5]>,
}

impl Flight {
    /// Creates a flight along keyframes. From one to the next the heading turns in the shorter
    /// direction.
    ///
    /// # Errors
    /// When there are too few or too many keyframes, times do not ascend, or a number is out of
    /// range.
    pub fn new(keyframes: &[Keyframe]) -> Result<Self, FlightError> {
        if !KEYFRAMES.contains(&keyframes.len()) {
            return Err(FlightError::Count { count: keyframes.len() });
        }
        let mut times_s: Vec<f64> = Vec::with_capacity(keyframes.len());
        let mut values: Vec<[f64; 5]> = Vec::with_capacity(keyframes.len());
        for (keyframe, number) in keyframes.iter().zip(1..) {
            check(keyframe, number)?;
            let Keyframe { time_s, pose: Pose { eye_m: [x, y, height_m], orientation } } =
                *keyframe;
            if let Some(&before_s) = times_s.last()
                && before_s >= time_s
            {
                return Err(FlightError::NotAscending { number, time_s, before_s });
            }
            let Orientation { heading_deg, pitch_deg } = orientation;
            let heading_deg = values.last().map_or(heading_deg, |before| {
                before[3] + (heading_deg - before[3] + 180.0).rem_euclid(360.0) - 180.0
            });
            times_s.push(time_s);
            values.push([x, y, height_m, heading_deg, pitch_deg]);
        }
        let slopes = slopes(&times_s, &values);
        Ok(Self { times_s, values, slopes })
    }

    /// Keyframes in order. Headings may be below 0° or above 360°.
    pub fn keyframes(&self) -> impl Iterator<Item = Keyframe> {
        self.times_s.iter().zip(&self.values).map(|(time_s, value)| {
            let [x, y, height_m, heading_deg, pitch_deg] = *value;
            let orientation = Orientation { heading_deg, pitch_deg };
            Keyframe { time_s: *time_s, pose: Pose { eye_m: [x, y, height_m], orientation } }
        })
    }

    /// Start and end time, seconds.
    #[must_use]
    pub fn span_s(&self) -> [f64; 2] {
        [self.times_s[0], self.times_s[self.times_s.len() - 1]]
    }

    /// Duration, seconds.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        let [begin_s, end_s] = self.span_s();
        end_s - begin_s
    }

    /// Returns the camera at a time; before the start and after the end it stands still.
    ///
    /// Source: Fritsch & Butland 1984, *A Method for Constructing Local Monotone Piecewise Cubic
    /// Interpolants*.
    #[must_use]
    pub fn at(&self, time_s: f64) -> Pose {
        let [begin_s, end_s] = self.span_s();
        let time_s = time_s.clamp(begin_s, end_s);
        let after = self.times_s.partition_point(|known_s| *known_s <= time_s);
        let k = after.clamp(1, self.times_s.len() - 1) - 1;
        let step_s = self.times_s[k + 1] - self.times_s[k];
        let t = (time_s - self.times_s[k]) / step_s;
        // Hermite's cubic polynomials: two with the value 1 at one end, two with the slope 1 at one
        // end; every other value and slope at the ends is 0.
        let [value_0, value_1] = [(1.0 + 2.0 * t) * (1.0 - t) * (1.0 - t), t * t * (3.0 - 2.0 * t)];
        let [slope_0, slope_1] = [t * (1.0 - t) * (1.0 - t), t * t * (t - 1.0)];
        let [x, y, height_m, heading_deg, pitch_deg] = [0, 1, 2, 3, 4].map(|axis| {
            let [from, to] = [self.values[k][axis], self.values[k + 1][axis]];
            let between = value_0 * from
                + value_1 * to
                + step_s * (slope_0 * self.slopes[k][axis] + slope_1 * self.slopes[k + 1][axis]);
            // Exact arithmetic gives a value between the two; rounding may add an ulp.
            between.clamp(from.min(to), from.max(to))
        });
        Pose { eye_m: [x, y, height_m], orientation: Orientation { heading_deg, pitch_deg } }
    }
}

fn check(keyframe: &Keyframe, number: usize) -> Result<(), FlightError> {
    let Keyframe { time_s, pose: Pose { eye_m: [x, y, height_m], orientation } } = *keyframe;
    let far = "a finite number within ±1e9";
    let within = |value: f64| value.abs() <= MOST;
    let pitch_fits = (0.0..=90.0).contains(&orientation.pitch_deg);
    for (name, value, fits, range) in [
        ("time_s", time_s, within(time_s), far),
        ("x_m", x, within(x), far),
        ("y_m", y, within(y), far),
        ("height_m", height_m, within(height_m), far),
        ("heading_deg", orientation.heading_deg, within(orientation.heading_deg), far),
        ("pitch_deg", orientation.pitch_deg, pitch_fits, "0 (straight down) to 90 (level)"),
    ] {
        if !fits {
            return Err(FlightError::Range { number, name, value, range });
        }
    }
    Ok(())
}

/// Derivatives at the keyframes, chosen so that no value between two keyframes is beyond the values
/// at these keyframes.
///
/// At inner keyframes the derivative is the weighted harmonic mean of the slopes of both sides, or
/// 0 if their signs differ (Fritsch & Butland 1984, formula 5, with the weights for unequal steps
/// by Fritsch, Butland & Carlson). At the first and the last keyframe the derivative is the slope
/// of the only side, which the same theorem allows.
fn slopes(times_s: &[f64], values: &[[f64; 5]]) -> Vec<[f64; 5]> {
    let last = times_s.len() - 1;
    let step_s = |k: usize| times_s[k + 1] - times_s[k];
    let secant = |k: usize, axis: usize| (values[k + 1][axis] - values[k][axis]) / step_s(k);
    let at = |k: usize, axis: usize| match k {
        0 => secant(0, axis),
        k if k == last => secant(last - 1, axis),
        k => {
            let (before, after) = (secant(k - 1, axis), secant(k, axis));
            if before * after <= 0.0 {
                return 0.0;
            }
            let (weight_0, weight_1) =
                (2.0 * step_s(k) + step_s(k - 1), step_s(k) + 2.0 * step_s(k - 1));
            (weight_0 + weight_1) / (weight_0 / before + weight_1 / after)
        }
    };
    (0..=last).map(|k| [0, 1, 2, 3, 4].map(|axis| at(k, axis))).collect()
}
