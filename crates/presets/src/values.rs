//! Parsers of single values in settings files and on the command line, such as memory sizes and
//! cells.

use bytesize::ByteSize;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use corniche_geom::Cell;
use corniche_settings::{MAX_NODATA, ReliefLevels};

/// Parses a number of bytes: without or with a unit, whole or with a decimal point. As in GNU's
/// tools, `K`, `M`, `G`, `T`, like `KiB`, `MiB`, `GiB`, `TiB`, are powers of 1024; `kB`, `MB`,
/// `GB`, `TB` are powers of 1000. Case is ignored.
///
/// # Errors
/// When the text is not a number of bytes, or is less than a byte, or does not fit in 64 bits.
pub fn parse_bytes(text: &str) -> Result<u64, String> {
    let is_short = text.ends_with(|last: char| "kmgtpe".contains(last.to_ascii_lowercase()));
    let with_unit = if is_short { format!("{text}iB") } else { text.to_owned() };
    match with_unit.parse() {
        // The largest number stands for all that are too large.
        Ok(ByteSize(size_bytes)) if ![0, u64::MAX].contains(&size_bytes) => Ok(size_bytes),
        _ => Err("write a size such as 800K, 512MiB, 64MB, 0.5G or 1T".to_owned()),
    }
}

/// Parses the lowest and the highest value of a range, in this order.
pub(crate) fn parse_range(text: &str) -> Result<[f64; 2], String> {
    let ends = text
        .split_once(',')
        .and_then(|(low, high)| Some([low.trim().parse().ok()?, high.trim().parse().ok()?]));
    match ends {
        Some(ends) if is_range(ends) => Ok(ends),
        _ => Err("write the lowest and the highest value, like -500,9000".to_owned()),
    }
}

/// Whether the first end is below the second, and both ends and their difference are finite.
fn is_range([low, high]: [f64; 2]) -> bool {
    low < high && (high - low).is_finite()
}

/// Rejects heights that are not a range.
pub(crate) fn check_height_range(given: &[[f64; 2]]) -> Result<(), String> {
    match given.iter().find(|ends| !is_range(**ends)) {
        Some([low, high]) => Err(format!(
            "height-range must be the lowest and the highest height, in this order, not {low}, {high}; write it like [-500, 9000]"
        )),
        None => Ok(()),
    }
}

/// Parses a cell, east and north: one number is a square.
pub(crate) fn parse_cell(text: &str) -> Result<Cell, String> {
    let side = |text: &str| text.trim().parse::<f64>().ok();
    let cell = match text.split_once(',') {
        Some((east, north)) => {
            side(east).zip(side(north)).map(|(east_m, north_m)| Cell { east_m, north_m })
        }
        None => side(text).map(Cell::from),
    };
    let cell = cell.ok_or("write metres like 30, or east,north like 20,30")?;
    check_cell(cell)?;
    Ok(cell)
}

/// Rejects sides that are not positive numbers.
fn check_cell(cell: Cell) -> Result<(), String> {
    match cell.to_array().iter().find(|side_m| !(**side_m > 0.0 && side_m.is_finite())) {
        Some(side_m) => Err(format!("a side must be a positive number of metres, not {side_m}")),
        None => Ok(()),
    }
}

/// Rejects cells with sides that are not positive numbers.
pub(crate) fn check_cells(given: &[Cell]) -> Result<(), String> {
    let check = |&cell| check_cell(cell).map_err(|error| format!("cell: {error}"));
    given.iter().try_for_each(check)
}

/// Rejects an error that is not a positive number.
pub(crate) fn check_max_error(given: &[f64]) -> Result<(), String> {
    match given.iter().find(|metres| !(**metres > 0.0 && metres.is_finite())) {
        Some(metres) => {
            Err(format!("--max-error must be a positive number of metres, not {metres}"))
        }
        None => Ok(()),
    }
}

/// Rejects a tolerance that is negative, or so large that nothing remains of a road.
pub(crate) fn check_simplify(given: &[f64]) -> Result<(), String> {
    match given.iter().find(|cells| !(0.0..=64.0).contains(*cells)) {
        Some(cells) => Err(format!("--simplify must be between 0 and 64 cells, not {cells}")),
        None => Ok(()),
    }
}

/// Rejects nodata values that are not finite, and too many of them.
pub(crate) fn check_nodata(given: &[Vec<f64>]) -> Result<(), String> {
    let [given] = given else { return Ok(()) };
    if let Some(value) = given.iter().find(|value| !value.is_finite()) {
        return Err(format!(
            "--nodata {value} is not needed: only finite numbers are treated as heights; omit it"
        ));
    }
    if given.len() > MAX_NODATA {
        return Err(format!(
            "--nodata is given {} times, more than {MAX_NODATA}; convert the files so that they declare their \
             nodata value (gdal_translate -a_nodata)",
            given.len()
        ));
    }
    Ok(())
}

/// The values of an option: the word of each, its help text (or an empty one), and its value.
pub type Words<T, const N: usize> = [(&'static str, &'static str, T); N];

/// The parser of one of these values, by its word.
pub fn one_of<T: Copy + Send + Sync + 'static, const N: usize>(
    values: Words<T, N>,
) -> impl TypedValueParser<Value = T> {
    let words = values.map(|(word, help, _)| {
        let value = PossibleValue::new(word);
        if help.is_empty() { value } else { value.help(help) }
    });
    PossibleValuesParser::new(words).try_map(move |given| {
        let found = values.iter().find(|(word, ..)| *word == given);
        found.map(|(_, _, value)| *value).ok_or("it is not a value of this option")
    })
}

/// The parser of one of two words; the second means yes.
pub(crate) fn either([no, yes]: [&'static str; 2]) -> impl TypedValueParser<Value = bool> {
    one_of([(no, "", false), (yes, "", true)])
}

/// Levels with relief, by name.
pub(crate) const RELIEF: Words<ReliefLevels, 3> = [
    ("off", "None", ReliefLevels::Off),
    ("finest", "The finest level only", ReliefLevels::Finest),
    ("full", "All levels", ReliefLevels::Full),
];

#[cfg(test)]
#[path = "values_tests.rs"]
mod tests;
