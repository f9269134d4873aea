//! Errors of flying a flight frame by frame.

use crate::{
    gpu::{GpuError, ReadBackError},
    range::OutOfRange,
    tiles::LoadTileError,
};

/// Why a flight cannot be flown.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum ReplayError {
    #[error(transparent)]
    Load(#[from] LoadTileError),
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error(transparent)]
    ReadBack(#[from] ReadBackError),
    #[error("the package has no ground to fly over")]
    NoGround,
    #[error(
        "at {time_s:.2} s the eye is {depth_m:.1} m too low: it lies under the ground; give its true height, in the \
         package's vertical datum"
    )]
    UnderGround { time_s: f64, depth_m: f64 },
    #[error(transparent)]
    Range(#[from] OutOfRange),
    #[error(
        "{wanted_bytes} bytes of tiles do not fit the {budget_bytes} bytes of graphics memory allowed; allow more{or_less}"
    )]
    OverBudget { wanted_bytes: u64, budget_bytes: u64, or_less: &'static str },
    #[error("stopped before the flight was over")]
    Stopped,
}
