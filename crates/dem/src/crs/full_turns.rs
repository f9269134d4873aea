//! Longitudes beside others: whole turns.

/// Full turns in a difference of longitudes, both in one unit. None in half a turn: on the other side of the earth both ways
/// are as long, and what lies there stays.
pub(crate) fn turns(difference: f64, turn: f64) -> f64 {
    let turns = difference / turn;
    if turns.abs() <= 0.5 + 1e-9 { 0.0 } else { turns.round() }
}
