//! Whole turns between longitudes.

/// How many full turns are in a difference of longitudes; both arguments have the same unit. The result is 0 for half
/// a turn: both ways around the earth are equally long, so the longitude stays as it is.
pub(crate) fn turns(difference: f64, turn: f64) -> f64 {
    let turns = difference / turn;
    if turns.abs() <= 0.5 + 1e-9 { 0.0 } else { turns.round() }
}
