//! Errors of drawing pictures and flights.

use crate::{
    gpu::{GpuError, ReadBackError},
    layers::UnknownLayer,
    range::OutOfRange,
    tiles::LoadTileError,
    viewpoint::ViewpointOffGround,
};

/// Why a picture or a flight cannot be drawn.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum DrawError {
    #[error(transparent)]
    Load(#[from] LoadTileError),
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error(transparent)]
    ReadBack(#[from] ReadBackError),
    #[error("{name:?} has no ground to show")]
    NoGround { name: String },
    #[error(transparent)]
    OffGround(#[from] ViewpointOffGround),
    #[error(
        "the eye would be {depth_m:.1} m too low: under the ground or too close to it; look from farther away, from another direction or more steeply down"
    )]
    EyeUnderGround { depth_m: f64 },
    #[error(transparent)]
    Range(#[from] OutOfRange),
    #[error(transparent)]
    Layer(#[from] UnknownLayer),
    #[error("interrupted")]
    Stopped,
    #[error("the package has no ground to fly over")]
    NothingBeneath,
    #[error(
        "at {time_s:.2} s the eye is under the ground, {depth_m:.1} m too low; write its true height in the \
         package's vertical datum"
    )]
    UnderGround { time_s: f64, depth_m: f64 },
    #[error(
        "the tiles need {wanted_bytes} bytes, but only {budget_bytes} bytes of graphics memory are allowed; raise the limit{or_less}"
    )]
    OverBudget { wanted_bytes: u64, budget_bytes: u64, or_less: &'static str },
    #[error("stopped before the end of the flight")]
    FlightStopped,
}
