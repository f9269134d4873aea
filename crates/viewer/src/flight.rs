//! A recorded way of the camera: keyframes in a text file, and where the camera is between them.
//!
//! ```toml
//! crs = "EPSG:2056"   # of x_m and y_m; may be left out
//! metres_per_unit = [1.0, 1.0]   # x_m and y_m are coordinates of that CRS times these; if left out, the package's
//!
//! [[keyframe]]
//! time_s = 0.0
//! lon_deg = 9.52      # WGS84; or x_m and y_m, in working metres
//! lat_deg = 47.14
//! height_m = 1800.0   # of the eye: true height, in the package's vertical datum
//! heading_deg = 45.0  # clockwise from north
//! pitch_deg = 65.0    # 0 looks straight down, 90 at the horizon
//!
//! [[keyframe]]
//! time_s = 12.5
//! # …
//! ```
//!
//! Between keyframes the camera moves smoothly and never farther in any coordinate than the two keyframes lie apart, so
//! that a way over the ground at its keyframes cannot dive between them.

mod over;

use corniche_geom::CoordinateTable;
use corniche_tileset::Manifest;
use serde::{Deserialize, Serialize};

use crate::camera::Orientation;

/// A flight has at least and at most so many keyframes: an hour at 25 a second and some room.
const KEYFRAMES: std::ops::RangeInclusive<usize> = 2..=100_000;
/// Times, positions and heights beyond this are mistakes.
const MOST: f64 = 1e9;

/// Where the eye is and how it looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// The eye: x, y in working metres and true height, metres.
    pub eye_m: [f64; 3],
    /// Direction of view.
    pub orientation: Orientation,
}

/// Where the camera is at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Keyframe {
    /// Seconds from the flight's beginning, or from any other fixed moment.
    pub time_s: f64,
    /// The camera.
    pub pose: Pose,
}

/// A way of the camera. Times ascend and every number is finite and in its range.
#[derive(Debug, Clone, PartialEq)]
pub struct Flight {
    times_s: Vec<f64>,
    /// x, y, height, heading (without jumps: 350° is followed by 370°) and pitch.
    values: Vec<[f64; 5]>,
    /// Their derivatives by time.
    slopes: Vec<[f64; 5]>,
}

/// Why there is no flight.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum FlightError {
    #[error("this is no flight: {message}")]
    Syntax { message: String },
    #[error("a flight needs {} to {} keyframes, not {count}", KEYFRAMES.start(), KEYFRAMES.end())]
    Count { count: usize },
    #[error("keyframe {number}: {name} of {value} is out of range; it must be {range}")]
    Range { number: usize, name: &'static str, value: f64, range: &'static str },
    #[error(
        "keyframe {number} is at {time_s} s, the one before at {before_s} s; times must ascend"
    )]
    NotAscending { number: usize, time_s: f64, before_s: f64 },
    #[error("keyframe {number} needs a place: either lon_deg and lat_deg, or x_m and y_m")]
    Place { number: usize },
    #[error(
        "keyframe {number}: longitude {lon_deg}, latitude {lat_deg} lies far outside the package"
    )]
    FarOutside { number: usize, lon_deg: f64, lat_deg: f64 },
    #[error(
        "its x_m and y_m are in {flight}, the package is in {package}; give lon_deg and lat_deg, or, if \
         they are the same, remove the line crs"
    )]
    OtherCrs { flight: String, package: String },
    #[error(
        "its metres_per_unit of {factors:?} are no factors; give those of the package it was made on"
    )]
    Factors { factors: [f64; 2] },
}

/// What x and y of a package are: coordinates of a CRS times factors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorkingCrs<'a> {
    /// Its name, as packages have it.
    pub crs: &'a str,
    /// Working metres to a unit of its coordinates, east and north.
    pub metres_per_unit: [f64; 2],
}

impl<'a> WorkingCrs<'a> {
    /// Of a package.
    #[must_use]
    pub fn of(manifest: &'a Manifest) -> Self {
        Self { crs: &manifest.crs, metres_per_unit: manifest.metres_per_unit }
    }
}

impl Flight {
    /// A flight along keyframes. Headings turn the shorter way from one to the next.
    ///
    /// # Errors
    /// When there are too few or too many, times do not ascend, or a number is out of range.
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

    /// Reads the text of a flight, as described at the top of this module. `working` and `coordinates` are the package's.
    ///
    /// Metres of the same CRS and other factors are another place: they are carried over by both factors.
    ///
    /// # Errors
    /// When it is no such text, or says something impossible; the message names the line or the keyframe. When it is meant
    /// for a package in another CRS.
    pub fn parse(
        text: &str,
        working: WorkingCrs<'_>,
        coordinates: &CoordinateTable,
    ) -> Result<Self, FlightError> {
        let file: FlightFile = toml::from_str(text)
            .map_err(|error| FlightError::Syntax { message: error.to_string() })?;
        if let Some(flight) = file.crs.filter(|known| known != working.crs)
            && file.keyframe.iter().any(|record| record.x_m.is_some())
        {
            return Err(FlightError::OtherCrs { flight, package: working.crs.to_owned() });
        }
        let factors = file.metres_per_unit.unwrap_or(working.metres_per_unit);
        if factors.iter().any(|factor| !factor.is_normal()) {
            return Err(FlightError::Factors { factors });
        }
        // 1 exactly where both have the same factors.
        let carry = [0, 1].map(|axis| working.metres_per_unit[axis] / factors[axis]);
        let keyframes: Result<Vec<Keyframe>, FlightError> = file
            .keyframe
            .iter()
            .zip(1..)
            .map(|(record, number)| record.place(number, carry, coordinates))
            .collect();
        Self::new(&keyframes?)
    }

    /// The text of this flight, in the working metres of a package: [`Self::parse`] reads back the same flight.
    ///
    /// # Errors
    /// Never for a flight made here; the writer of the text is another's.
    pub fn to_text(&self, working: WorkingCrs<'_>) -> Result<String, FlightError> {
        let keyframe = self.keyframes().map(|Keyframe { time_s, pose }| {
            let [x, y, height_m] = pose.eye_m;
            KeyframeRecord {
                time_s,
                lon_deg: None,
                lat_deg: None,
                x_m: Some(x),
                y_m: Some(y),
                height_m,
                heading_deg: pose.orientation.heading_deg,
                pitch_deg: pose.orientation.pitch_deg,
            }
        });
        let file = FlightFile {
            crs: Some(working.crs.to_owned()),
            metres_per_unit: Some(working.metres_per_unit),
            keyframe: keyframe.collect(),
        };
        toml::to_string(&file).map_err(|error| FlightError::Syntax { message: error.to_string() })
    }

    /// Its keyframes in order. Headings may be beyond a full turn.
    pub fn keyframes(&self) -> impl Iterator<Item = Keyframe> {
        self.times_s.iter().zip(&self.values).map(|(time_s, value)| {
            let [x, y, height_m, heading_deg, pitch_deg] = *value;
            let orientation = Orientation { heading_deg, pitch_deg };
            Keyframe { time_s: *time_s, pose: Pose { eye_m: [x, y, height_m], orientation } }
        })
    }

    /// When it begins and ends, seconds.
    #[must_use]
    pub fn span_s(&self) -> [f64; 2] {
        [self.times_s[0], self.times_s[self.times_s.len() - 1]]
    }

    /// How long it takes, seconds.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        let [begin_s, end_s] = self.span_s();
        end_s - begin_s
    }

    /// The camera at a time; before the beginning and after the end it stands still.
    ///
    /// Source: Fritsch & Butland 1984, *A Method for Constructing Local Monotone Piecewise Cubic Interpolants*.
    #[must_use]
    pub fn at(&self, time_s: f64) -> Pose {
        let [begin_s, end_s] = self.span_s();
        let time_s = time_s.clamp(begin_s, end_s);
        let after = self.times_s.partition_point(|known_s| *known_s <= time_s);
        let k = after.clamp(1, self.times_s.len() - 1) - 1;
        let step_s = self.times_s[k + 1] - self.times_s[k];
        let t = (time_s - self.times_s[k]) / step_s;
        // Hermite's cubics: 1 at one end and flat at the other; slope 1 at one end.
        let [value_0, value_1] = [(1.0 + 2.0 * t) * (1.0 - t) * (1.0 - t), t * t * (3.0 - 2.0 * t)];
        let [slope_0, slope_1] = [t * (1.0 - t) * (1.0 - t), t * t * (t - 1.0)];
        let [x, y, height_m, heading_deg, pitch_deg] = [0, 1, 2, 3, 4].map(|axis| {
            let [from, to] = [self.values[k][axis], self.values[k + 1][axis]];
            let between = value_0 * from
                + value_1 * to
                + step_s * (slope_0 * self.slopes[k][axis] + slope_1 * self.slopes[k + 1][axis]);
            // Monotone in exact arithmetic; rounding may stray by an ulp.
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

/// Derivatives at the keyframes such that between two of them nothing overshoots.
///
/// In the middle the weighted harmonic mean of the slopes of both sides, 0 where they disagree in sign (Fritsch & Butland
/// 1984, formula 5 as weighted for unequal steps by Fritsch, Butland & Carlson); at the ends the slope of the one side,
/// which the same theorem allows.
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

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FlightFile {
    #[serde(skip_serializing_if = "Option::is_none")]
    crs: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    metres_per_unit: Option<[f64; 2]>,
    keyframe: Vec<KeyframeRecord>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct KeyframeRecord {
    time_s: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    lon_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    lat_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    x_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    y_m: Option<f64>,
    height_m: f64,
    heading_deg: f64,
    pitch_deg: f64,
}

impl KeyframeRecord {
    /// The keyframe, x and y times `carry`.
    fn place(
        &self,
        number: usize,
        carry: [f64; 2],
        coordinates: &CoordinateTable,
    ) -> Result<Keyframe, FlightError> {
        let [x, y] = match (self.lon_deg, self.lat_deg, self.x_m, self.y_m) {
            (None, None, Some(x), Some(y)) => [x * carry[0], y * carry[1]],
            (Some(lon_deg), Some(lat_deg), None, None) => {
                for (name, value, most, range) in [
                    ("lon_deg", lon_deg, 360.0, "within ±360 degrees"),
                    ("lat_deg", lat_deg, 90.0, "within ±90 degrees"),
                ] {
                    // Written so that what is not a number fails.
                    if !(-most..=most).contains(&value) {
                        return Err(FlightError::Range { number, name, value, range });
                    }
                }
                coordinates
                    .working_from_wgs84([lon_deg, lat_deg])
                    .ok_or(FlightError::FarOutside { number, lon_deg, lat_deg })?
            }
            _ => return Err(FlightError::Place { number }),
        };
        let orientation = Orientation { heading_deg: self.heading_deg, pitch_deg: self.pitch_deg };
        Ok(Keyframe {
            time_s: self.time_s,
            pose: Pose { eye_m: [x, y, self.height_m], orientation },
        })
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "keyframes are met exactly")]
#[path = "flight_tests.rs"]
mod tests;
