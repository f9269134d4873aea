//! Numbers with units in the tags of ways.

use std::num::{NonZeroU8, NonZeroU32};

/// Reads the number of lanes: a whole number from 1 to 255. `None` for anything else.
///
/// Source: OSM wiki, *Key:lanes*.
pub(crate) fn lanes(tagged: &str) -> Option<NonZeroU8> {
    is_digits(tagged).then(|| tagged.parse().ok()).flatten()
}

/// The maximum width, millimetres: a larger number was meant in another unit.
const WIDEST_MM: f64 = 1e6;

/// Reads a width in whole millimetres, more than 0 and at most 1 km: metres without a unit,
/// otherwise `m`, `cm`, `mm`, `km`, `mi`, `ft`, or feet and inches as `12'6"`. `None` for anything
/// else, including decimal commas and ranges.
///
/// Source: OSM wiki, *Key:width*, *Map features/Units*.
pub(crate) fn width_mm(tagged: &str) -> Option<NonZeroU32> {
    const FOOT_MM: f64 = 304.8;
    const INCH_MM: f64 = 25.4;
    let mm = match tagged.split_once('\'') {
        Some((feet, "")) => number(feet)? * FOOT_MM,
        Some((feet, inches)) => {
            number(feet)? * FOOT_MM + number(inches.trim().strip_suffix('"')?)? * INCH_MM
        }
        None => {
            let (value, unit) = number_and_unit(tagged)?;
            let unit_mm = match unit {
                "" | "m" => 1e3,
                "mm" => 1.0,
                "cm" => 10.0,
                "km" => 1e6,
                "ft" => FOOT_MM,
                "\"" => INCH_MM,
                "mi" => 1_609_344.0,
                _ => return None,
            };
            value * unit_mm
        }
    };
    let mm = mm.round();
    (mm <= WIDEST_MM).then(|| NonZeroU32::new(mm as u32)).flatten()
}

/// Returns a speed limit as text: whole numbers of km/h as the number alone, whole numbers of miles
/// per hour as `30 mph`, and anything else, such as `none`, `walk` or `CH:urban`, as tagged.
///
/// Source: OSM wiki, *Key:maxspeed*.
pub(crate) fn max_speed(tagged: &str) -> String {
    let whole =
        number_and_unit(tagged.trim()).filter(|(value, _)| value.fract() == 0.0 && *value < 1e4);
    match whole {
        Some((value, "" | "km/h" | "kmh" | "kph")) => format!("{value}"),
        Some((value, "mph")) => format!("{value} mph"),
        _ => tagged.to_owned(),
    }
}

/// Splits a text into a number and the unit after it, without the spaces between them. The number
/// has digits and at most one point: no sign, no exponent and no decimal comma.
#[must_use]
pub fn number_and_unit(text: &str) -> Option<(f64, &str)> {
    let end = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
    let (value, unit) = text.split_at(end);
    Some((number(value)?, unit.trim_start()))
}

/// Reads digits with at most one point: no sign, no exponent, and no words that Rust reads as
/// numbers.
fn number(text: &str) -> Option<f64> {
    let text = text.trim();
    let is_number = match text.split_once('.') {
        Some((whole, part)) => is_digits(whole) && is_digits(part),
        None => is_digits(text),
    };
    is_number.then(|| text.parse().ok()).flatten()
}

fn is_digits(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}

#[cfg(test)]
#[path = "quantities_tests.rs"]
mod tests;
