//! Single values in settings files and on the command line, such as amounts of memory and cells.

use bytesize::ByteSize;

/// A number of bytes: alone, or with a unit, whole or with a decimal point. As in GNU's tools `K`, `M`, `G`, `T`, like `KiB`, `MiB`,
/// `GiB`, `TiB`, are powers of 1024; `kB`, `MB`, `GB`, `TB` are powers of 1000. Large and small letters are the same.
///
/// # Errors
/// When the text is no such number, or less than a byte, or more than fits in 64 bits.
pub fn parse_bytes(text: &str) -> Result<u64, String> {
    let is_short = text.ends_with(|last: char| "kmgtpe".contains(last.to_ascii_lowercase()));
    let with_unit = if is_short { format!("{text}iB") } else { text.to_owned() };
    match with_unit.parse() {
        // The largest number stands for all that are too large.
        Ok(ByteSize(size_bytes)) if ![0, u64::MAX].contains(&size_bytes) => Ok(size_bytes),
        _ => Err("write it like 800K, 512MiB, 64MB, 0.5G or 1T".to_owned()),
    }
}

/// The least memory: with less a build cannot hold a tile for each of a few threads.
const MIN_MEMORY_BYTES: u64 = 256 << 20;

/// Memory that is enough to build in, bytes.
///
/// # Errors
/// When the text is no size, or one that is too small.
pub fn parse_memory(text: &str) -> Result<u64, String> {
    match parse_bytes(text) {
        Ok(size_bytes) if size_bytes >= MIN_MEMORY_BYTES => Ok(size_bytes),
        _ => Err(format!(
            "{text:?} is not a size of at least 256M; write it like 512M, 800MB, 0.5G or 1T"
        )),
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
