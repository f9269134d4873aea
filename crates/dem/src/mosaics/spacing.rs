//! Spacing and phase of a grid of samples, without the rounding of the program that wrote the file.

/// Numbers with few digits may move samples by this, over the whole extent, in cells.
const NOISE_CELLS: f64 = 5e-4;
/// Rounding of a grid's phase, in steps per unit: small enough that it removes only the noise in corner coordinates.
const PHASE_STEPS: f64 = 1e6;
/// The same in degrees, in steps per cell: degrees are written with fewer digits. Rounding moves nodes by half a step
/// at most.
const PHASE_STEPS_DEGREES: f64 = 1e4;

/// A spacing without the rounding of the program that wrote the file: a whole number of samples per unit (1/1200 of a
/// degree), or a number of few decimal digits. If neither is near, the spacing stays as it is.
pub(crate) fn nice(spacing: f64, reach: f64) -> f64 {
    let is_noise = |nice: f64| (nice - spacing).abs() * reach <= NOISE_CELLS * spacing;
    let digits = rounded(spacing, 9);
    let to_a_unit = 1.0 / (1.0 / spacing).round();
    [to_a_unit, digits]
        .into_iter()
        .find(|&nice| nice.is_finite() && is_noise(nice))
        .unwrap_or(spacing)
}

/// Where samples lie between two multiples of their spacing, so that adjoining files of one product have the same grid.
pub(crate) fn phase(at: f64, spacing: f64, is_degrees: bool) -> f64 {
    let (unit, steps) =
        if is_degrees { (spacing, PHASE_STEPS_DEGREES) } else { (1.0, PHASE_STEPS) };
    let phase = (at.rem_euclid(spacing) / unit * steps).round() / steps * unit;
    // A phase just below the spacing is the next multiple, so 0.
    if spacing - phase < 0.5 * unit / steps { 0.0 } else { phase }
}

/// A number rounded to so many significant decimal digits.
pub(crate) fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}
