//! Grades of roads without the noise of elevation models.
//!
//! Heights of a road are those of the elevation files; grades are those of a smooth line near them. It is the one that is nearest to the heights and
//! bends least: least squares, as a stiff ruler is laid through scattered points. It is a measure, never a geometry.
//!
//! ```text
//!   heights along a chain ──► one height for each junction ──► a smooth line for each chain ──► what lies on each way
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
