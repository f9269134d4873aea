//! Tables as plain text.

use std::{fmt::Write as _, ops::Range};

use crate::{escaped::shortened, messages};

/// Rows below headings; columns are as wide as needed, up to [`MAX_CELL`]; the first column is
/// left-aligned, the others right-aligned.
pub(crate) struct Table {
    rows: Vec<Vec<String>>,
}

impl Table {
    pub(crate) fn new<const N: usize>(headings: [&str; N]) -> Self {
        let mut table = Self { rows: Vec::new() };
        table.row(headings.map(str::to_owned));
        table
    }

    pub(crate) fn row<const N: usize>(&mut self, cells: [String; N]) {
        self.rows.push(cells.map(|cell| shortened(&cell, MAX_CELL).into_owned()).into());
    }

    /// Removes columns that are empty except for their heading.
    pub(crate) fn without_empty_columns(mut self) -> Self {
        for column in (0..self.rows[0].len()).rev() {
            if self.rows[1..].iter().all(|row| row[column].is_empty()) {
                self.rows.iter_mut().for_each(|row| drop(row.remove(column)));
            }
        }
        self
    }

    /// The table in lines of at most [`MAX_WIDTH`] characters: columns that do not fit follow
    /// below, next to the first column again.
    pub(crate) fn to_text(&self) -> String {
        let width = |column: usize| {
            self.rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..self.rows[0].len()).map(width).collect();
        let blocks: Vec<String> =
            folds(&widths).into_iter().map(|columns| self.block(&widths, columns)).collect();
        blocks.join("\n")
    }

    /// The first column followed by these columns.
    fn block(&self, widths: &[usize], columns: Range<usize>) -> String {
        let mut text = String::new();
        for row in &self.rows {
            let mut line = format!("{:<width$}", row[0], width = widths[0]);
            for column in columns.clone() {
                let _ = write!(line, "{GAP}{:>width$}", row[column], width = widths[column]);
            }
            text.push_str(line.trim_end());
            text.push('\n');
        }
        text
    }
}

/// The largest number of characters in a line of a table.
const MAX_WIDTH: usize = 100;
/// The largest number of characters in a cell. Foreign texts may have any length, but do not
/// determine the width of a column.
const MAX_CELL: usize = 80;
/// The gap between two columns.
const GAP: &str = "  ";

/// Distributes columns to blocks next to the first column: as few blocks as possible, and each as
/// narrow as possible.
fn folds(widths: &[usize]) -> Vec<Range<usize>> {
    let widest = folds_within(widths, MAX_WIDTH);
    let narrower = (0..MAX_WIDTH).map(|limit| folds_within(widths, limit));
    narrower.into_iter().find(|blocks| blocks.len() == widest.len()).unwrap_or(widest)
}

/// Blocks with as many columns as fit, at least one.
fn folds_within(widths: &[usize], limit: usize) -> Vec<Range<usize>> {
    let mut blocks = Vec::new();
    let mut begin = 1;
    let mut width = widths[0];
    for (column, own) in widths.iter().enumerate().skip(1) {
        let wider = width + GAP.len() + own;
        if wider > limit && column > begin {
            blocks.push(begin..column);
            (begin, width) = (column, widths[0] + GAP.len() + own);
        } else {
            width = wider;
        }
    }
    blocks.push(begin..widths.len());
    blocks
}

/// Wraps a text at spaces to lines of at most [`MAX_WIDTH`] characters; a longer word stays whole.
/// The first line begins with `first`, the others with `rest`.
pub(crate) fn wrapped(text: &str, first: &str, rest: &str) -> String {
    let mut lines = String::from(first);
    let mut width = first.chars().count();
    let mut is_begun = false;
    for word in text.split(' ') {
        let own = word.chars().count();
        if is_begun && width + 1 + own > MAX_WIDTH {
            lines.truncate(lines.trim_end().len());
            let _ = write!(lines, "\n{rest}");
            width = rest.chars().count();
        } else if is_begun {
            lines.push(' ');
            width += 1;
        }
        lines.push_str(word);
        width += own;
        is_begun = true;
    }
    lines
}

/// The format of whole numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Digits {
    /// Grouped by thousands, for people.
    Apart,
    /// Digits only, for programs that read a file or a pipe.
    Plain,
}

impl Digits {
    /// The format of numbers on standard output.
    pub(crate) fn of_answers() -> Self {
        if messages::answers_are_seen() { Self::Apart } else { Self::Plain }
    }

    /// The format of numbers in notes.
    pub(crate) fn of_notes() -> Self {
        if messages::notes_are_seen() { Self::Apart } else { Self::Plain }
    }

    /// A whole number.
    pub(crate) fn count(self, number: u64) -> String {
        let digits = number.to_string();
        if self == Self::Plain {
            return digits;
        }
        let mut text = String::new();
        for (index, digit) in digits.chars().enumerate() {
            if index > 0 && (digits.len() - index).is_multiple_of(3) {
                text.push('\u{202f}');
            }
            text.push(digit);
        }
        text
    }
}

/// A whole number in notes.
pub(crate) fn noted(number: u64) -> String {
    Digits::of_notes().count(number)
}

/// A size for people.
pub(crate) fn bytes(size: u64) -> String {
    match size {
        0..10_000 => format!("{size} B"),
        10_000..10_000_000 => format!("{:.1} kB", size as f64 / 1e3),
        10_000_000..10_000_000_000 => format!("{:.1} MB", size as f64 / 1e6),
        _ => format!("{:.1} GB", size as f64 / 1e9),
    }
}

/// A length for people, from micrometres.
pub(crate) fn length(micrometres: u64) -> String {
    let metres = micrometres as f64 / 1e6;
    if metres < 1000.0 { format!("{metres:.1} m") } else { format!("{:.1} km", metres / 1000.0) }
}

/// An upper bound for a value, with this many decimals: rounded up.
pub(crate) fn up_to(value: f64, decimals: u8) -> String {
    let steps = 10_f64.powi(decimals.into());
    // A multiple that is not quite exact is not rounded up to the next.
    format!("{:.*}", decimals.into(), (value * steps - 1e-6).ceil().max(0.0) / steps)
}

#[cfg(test)]
#[path = "table_tests.rs"]
mod tests;
