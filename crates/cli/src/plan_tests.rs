//! Times in a plan are told in units that fit.

use super::*;

#[test]
fn times_are_told_in_units_that_fit() {
    let told = [0.4, 119.0, 121.0, 7200.0, 100_000.0].map(duration);
    assert_eq!(told, ["0 s", "119 s", "2 min", "2.0 h", "27.8 h"]);
}
