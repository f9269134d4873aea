//! Errors of flights: keyframes that make no path.

use super::keyframe::KEYFRAMES;

/// Why there is no flight.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum FlightError {
    #[error("this is not a flight: {message}")]
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
        "its metres_per_unit of {}, {} cannot be used as factors; give those of the package that the flight was recorded on",
        .factors[0], .factors[1]
    )]
    Factors { factors: [f64; 2] },
}
