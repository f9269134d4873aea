//! Errors of flights: keyframes that do not form a path.

use super::keyframe::KEYFRAMES;

/// Why a flight is not valid.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum FlightError {
    #[error("not a valid flight: {message}")]
    Syntax { message: String },
    #[error("a flight needs {} to {} keyframes, not {count}", KEYFRAMES.start(), KEYFRAMES.end())]
    Count { count: usize },
    #[error("keyframe {number}: {name} of {value} is out of range; it must be {range}")]
    Range { number: usize, name: &'static str, value: f64, range: &'static str },
    #[error(
        "keyframe {number} is at {time_s} s, the previous one at {before_s} s; times must ascend"
    )]
    NotAscending { number: usize, time_s: f64, before_s: f64 },
    #[error("keyframe {number} needs a position: either lon_deg and lat_deg, or x_m and y_m")]
    Place { number: usize },
    #[error(
        "keyframe {number}: longitude {lon_deg}, latitude {lat_deg} is far outside the package"
    )]
    FarOutside { number: usize, lon_deg: f64, lat_deg: f64 },
    #[error(
        "x_m and y_m of the flight are in {flight}, but the package is in {package}; write lon_deg and lat_deg, or, if \
         both are the same CRS, remove the crs line"
    )]
    OtherCrs { flight: String, package: String },
    #[error(
        "the flight's metres_per_unit of {}, {} cannot be used as factors; use the values of the package on which the flight was recorded",
        .factors[0], .factors[1]
    )]
    Factors { factors: [f64; 2] },
}
