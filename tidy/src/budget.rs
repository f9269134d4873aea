//! Counts the bytes of product code by crate, and compares them with their budget.
//!
//! A row of `tidy/budget.toml` sinks with its crate. It rises only in a commit that names the
//! feature and the bytes (`CONTRIBUTING.md`); a commit that only renames or rewords may raise it,
//! too.

use std::{
    collections::BTreeMap,
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result};

use crate::{
    figures::test_lines,
    files::files_below,
    source::{crates_of, is_test_file},
};

/// The path of the budget, relative to the root.
pub const BUDGET: &str = "tidy/budget.toml";

/// The languages of handwritten code: the extension of a file's name, and the start of a comment on
/// a separate line.
const LANGUAGES: [(&str, &str); 6] =
    [("rs", "//"), ("wgsl", "//"), ("js", "//"), ("mjs", "//"), ("py", "#"), ("sh", "#")];
/// Folders of product code in addition to the crates.
const FOLDERS: [&str; 3] = ["config", "python", "scripts"];
/// Folders whose files are tests, measurements, examples, or the page that is generated from the
/// crates.
const NOT_PRODUCT: [&str; 5] = ["tests", "benches", "examples", "fuzz_targets", "page"];
/// A crate that only serves tests.
const FOR_TESTS: &str = "testing";

/// Bytes of product code by crate or folder.
pub type Bytes = BTreeMap<String, u64>;

/// Counts the product code below `root`: lines that are neither empty, comments nor tests, without
/// their indentation.
///
/// # Errors
/// When a file cannot be read or is not valid Rust.
pub fn product_bytes(root: &Path) -> Result<Bytes> {
    let mut rows = Bytes::new();
    let crates = crates_of(root)?;
    for folder in crates.into_iter().chain(FOLDERS.map(|name| root.join(name))) {
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if name == FOR_TESTS {
            continue;
        }
        let mut bytes = 0;
        for (language, comment) in LANGUAGES {
            for file in files_below(&folder, language)? {
                bytes += bytes_of(&folder, &file, comment)?;
            }
        }
        if name == "scripts" {
            for file in scripts_without_ending(&folder)? {
                bytes += bytes_of(&folder, &file, "#")?;
            }
        }
        rows.insert(name, bytes);
    }
    Ok(rows)
}

/// Lists scripts, whose names have no extension. Scripts that only run tests are not product code.
fn scripts_without_ending(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for entry in
        fs::read_dir(folder).with_context(|| format!("cannot list {}", folder.display()))?
    {
        let path = entry?.path();
        let is_test =
            path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("test"));
        if path.is_file() && path.extension().is_none() && !is_test {
            found.push(path);
        }
    }
    Ok(found)
}

fn bytes_of(folder: &Path, file: &Path, comment: &str) -> Result<u64> {
    let inside = file.strip_prefix(folder).unwrap_or(file);
    let is_left_out = |part: &std::ffi::OsStr| NOT_PRODUCT.iter().any(|name| part == *name);
    if inside.iter().any(is_left_out) || is_test_file(inside) {
        return Ok(0);
    }
    let text =
        fs::read_to_string(file).with_context(|| format!("cannot read {}", file.display()))?;
    let tests = if file.extension().is_some_and(|ending| ending == "rs") {
        let parsed = syn::parse_file(&text)
            .with_context(|| format!("{} is not valid Rust", file.display()))?;
        test_lines(&parsed)
    } else {
        Vec::new()
    };
    Ok(code_bytes(&text, comment, &tests))
}

/// The bytes of those lines of a text, each with its line end, that are neither empty nor comments
/// nor in `tests` (first and last line, from 1).
fn code_bytes(text: &str, comment: &str, tests: &[[usize; 2]]) -> u64 {
    let mut bytes = 0;
    // The end of the block comment or docstring that contains the current line.
    let mut block: Option<&str> = None;
    for (number, line) in (1..).zip(text.lines().map(str::trim)) {
        if let Some(end) = block {
            block = (!line.contains(end)).then_some(end);
            continue;
        }
        let opens = [("/*", "*/"), ("\"\"\"", "\"\"\"")];
        let of_language = &opens[usize::from(comment == "#")];
        if let Some(rest) = line.strip_prefix(of_language.0) {
            block = (!rest.contains(of_language.1)).then_some(of_language.1);
            continue;
        }
        let is_test = tests.iter().any(|&[first, last]| (first..=last).contains(&number));
        if !line.is_empty() && !line.starts_with(comment) && !is_test {
            bytes += line.len() as u64 + 1;
        }
    }
    bytes
}

/// Reads a budget: a name and a number on each line.
///
/// # Errors
/// When a line has another form.
pub fn read_budget(text: &str) -> Result<Bytes> {
    let rows =
        text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
    rows.map(|line| {
        let (name, bytes) = line.split_once('=').context("expected `name = bytes`")?;
        Ok((name.trim().trim_matches('"').to_owned(), bytes.trim().replace('_', "").parse()?))
    })
    .collect::<Result<_>>()
    .with_context(|| format!("{BUDGET} cannot be read"))
}

/// The budget for the current code: rows sink, and none rises. A new crate has no row until someone
/// adds one.
///
/// # Errors
/// Never: writing into memory cannot fail.
pub fn sunk(budget: &Bytes, found: &Bytes) -> Result<String> {
    let mut text = String::from(
        "# Bytes of product code that each crate may have: `cargo run -p corniche-tidy -- budget` counts, `budget --sink` lowers.\n\
         # A row rises only in a commit that names the feature and the bytes.\n",
    );
    for (name, row) in budget {
        if let Some(bytes) = found.get(name) {
            writeln!(text, "{name} = {}", row.min(bytes))?;
        }
    }
    Ok(text)
}

/// Violations of the budget: a crate above its row, a crate without a row, or a crate so far below
/// its row that the row must sink.
#[must_use]
pub fn over_budget(budget: &Bytes, found: &Bytes) -> Vec<String> {
    let mut wrong = Vec::new();
    for (name, &bytes) in found {
        match budget.get(name) {
            None => wrong.push(format!("{name} has {bytes} bytes but no row in {BUDGET}")),
            Some(&row) if bytes > row => {
                wrong.push(format!("{name} has {bytes} bytes, {} more than its row", bytes - row));
            }
            // The tolerance is a hundredth, so that not every small change must touch the table.
            Some(&row) if row - bytes > row / 100 => {
                wrong.push(format!("{name} has {bytes} bytes, and its row is {row}: lower it"));
            }
            Some(_) => {}
        }
    }
    let gone = budget.keys().filter(|name| !found.contains_key(*name));
    wrong.extend(gone.map(|name| format!("{name} has a row in {BUDGET} but does not exist")));
    wrong
}

#[cfg(test)]
#[path = "budget_tests.rs"]
mod tests;
