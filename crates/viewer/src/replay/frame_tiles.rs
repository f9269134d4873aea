//! The tiles of one frame of a flight, and what it took to have them.

use crate::lod::Drawn;

/// The tiles of one frame, and what was done to have them.
#[derive(Default)]
pub(crate) struct FrameTiles {
    /// The tiles to draw.
    pub(crate) drawn: Vec<Drawn>,
    /// How many were read and decoded.
    pub(crate) loaded: usize,
    /// How many were handed to the graphics card.
    pub(crate) uploaded: usize,
    /// How many were removed from the graphics card.
    pub(crate) evicted: usize,
    /// How many the view wants that are not there yet.
    pub(crate) missing: usize,
    pub(crate) select_ms: f64,
    pub(crate) decode_ms: f64,
    pub(crate) upload_ms: f64,
}
