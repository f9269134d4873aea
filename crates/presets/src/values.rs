//! Texts of single values.

/// A number of bytes, with one of the units K, M, G and T (powers of 1024) or none.
///
/// # Errors
/// When the text is no such number, or 0.
pub fn parse_bytes(text: &str) -> Result<u64, String> {
    let (digits, unit) = match text.char_indices().last() {
        Some((at, 'K' | 'k')) => (&text[..at], 1 << 10),
        Some((at, 'M' | 'm')) => (&text[..at], 1 << 20),
        Some((at, 'G' | 'g')) => (&text[..at], 1 << 30),
        Some((at, 'T' | 't')) => (&text[..at], 1 << 40),
        _ => (text, 1),
    };
    let number: Option<u64> = digits.parse().ok();
    match number.and_then(|number| number.checked_mul(unit)) {
        Some(size_bytes @ 1..) => Ok(size_bytes),
        _ => Err("write it like 800K, 512M, 4G or 1T".to_owned()),
    }
}

/// With less than this a build cannot hold a tile for each of a few threads.
const MIN_MEMORY_BYTES: u64 = 256 << 20;

/// Memory that is enough to build in, bytes.
///
/// # Errors
/// When the text is no size, or one that is too small.
pub fn parse_memory(text: &str) -> Result<u64, String> {
    match parse_bytes(text) {
        Ok(size_bytes) if size_bytes >= MIN_MEMORY_BYTES => Ok(size_bytes),
        _ => Err(format!("{text:?} is not a size of at least 256M; write it like 512M, 4G or 1T")),
    }
}

/// The lowest and the highest of something, in this order.
pub(crate) fn parse_range(text: &str) -> Result<[f64; 2], String> {
    let ends = text
        .split_once(',')
        .and_then(|(low, high)| Some([low.trim().parse().ok()?, high.trim().parse().ok()?]));
    match ends {
        Some(ends) if is_range(ends) => Ok(ends),
        _ => Err("write the lowest and the highest like -500,9000".to_owned()),
    }
}

/// Whether the first of two ends lies below the second, and both are finite and not farther apart than a number can say.
#[must_use]
pub fn is_range([low, high]: [f64; 2]) -> bool {
    low < high && (high - low).is_finite()
}

/// A cell, east and north: one number is a square.
pub(crate) fn parse_cell(text: &str) -> Result<[f64; 2], String> {
    let side = |text: &str| text.trim().parse::<f64>().ok();
    let sides_m = match text.split_once(',') {
        Some((east, north)) => {
            side(east).zip(side(north)).map(|(east_m, north_m)| [east_m, north_m])
        }
        None => side(text).map(|side_m| [side_m; 2]),
    };
    match sides_m {
        Some(sides_m) => check_cell(sides_m),
        None => Err("write metres like 30, or east,north like 20,30".to_owned()),
    }
}

/// Sides that can be those of a cell, east and north.
///
/// # Errors
/// When a side is no positive number.
pub fn check_cell(sides_m: [f64; 2]) -> Result<[f64; 2], String> {
    match sides_m.iter().find(|side_m| !(**side_m > 0.0 && side_m.is_finite())) {
        Some(side_m) => Err(format!("a side must be a positive number of metres, not {side_m}")),
        None => Ok(sides_m),
    }
}

#[cfg(test)]
#[path = "values_tests.rs"]
mod tests;
