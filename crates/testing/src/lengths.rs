//! Lengths of lines, computed with simple methods.

use corniche_geom::Polyline;

/// Length of a line in plan, in lattice steps.
#[must_use]
pub fn length_steps(line: &Polyline) -> f64 {
    line.points().windows(2).map(|pair| pair[0].distance_steps(pair[1])).sum()
}
