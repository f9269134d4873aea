//! Grades of roads without the noise of elevation models.
//!
//! The heights of a road are those of the elevation files. Its grades are those of a smooth line
//! near these heights: the line that minimises the squared distances from the heights and its own
//! bending (least squares), like a stiff ruler through scattered points. The smooth line serves for
//! measuring only, and never becomes geometry.
//!
//! ```text
//!   heights along a chain ──► one height for each junction ──► a smooth line for each chain ──► the part of each way
//! ```

mod junctions;
mod measured_chains;
mod on_way;
mod smooth_line;
mod smoothing;
mod span_decks;

pub(crate) use measured_chains::MeasuredChains;
pub(crate) use on_way::{most_steps, stretch_of_way};
pub(crate) use smooth_line::{GRADE_LENGTH_M, SmoothLine, Station, grades_of};
pub(crate) use smoothing::Smoothing;
