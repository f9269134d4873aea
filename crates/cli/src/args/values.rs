//! Parsers of single values on the command line, such as packages, sizes and positions.

use std::{
    ffi::OsStr,
    ops::RangeInclusive,
    path::{Path, PathBuf},
    str::FromStr,
};

use clap::{builder::TypedValueParser, error::ErrorKind};
use corniche_presets::Words;
use corniche_remote::PackagePlace;

use crate::{
    failure::{CommandFailure, Result},
    names::is_package_name,
};

/// The word of a value.
pub(crate) fn word_of<T: PartialEq, const N: usize>(
    values: &Words<T, N>,
    value: &T,
) -> &'static str {
    values.iter().find(|(_, _, own)| own == value).map_or("", |(word, ..)| word)
}

/// The parser of a package: a file, or a URL.
pub(crate) fn package_place() -> impl TypedValueParser<Value = PackagePlace> {
    PlaceParser
}

/// Parses the place of a package. Unlike clap's own parsers, it does not repeat an invalid text in
/// its message, because a URL may contain a password.
#[derive(Debug, Clone)]
struct PlaceParser;

impl TypedValueParser for PlaceParser {
    type Value = PackagePlace;

    fn parse_ref(
        &self,
        command: &clap::Command,
        _argument: Option<&clap::Arg>,
        value: &OsStr,
    ) -> Result<PackagePlace, clap::Error> {
        PackagePlace::parse(value.to_os_string()).map_err(|error| {
            clap::Error::raw(ErrorKind::ValueValidation, format!("{error}\n")).with_cmd(command)
        })
    }
}

/// The package among several files.
///
/// # Errors
/// When it is an invalid URL.
fn place_of(file: PathBuf) -> Result<PackagePlace> {
    PackagePlace::parse(file.into()).map_err(CommandFailure::unusable)
}

/// Whether one of several files may be the package: its name says so, or it is a URL (even an
/// invalid one), which no other input can be.
fn may_be_package(file: &Path) -> bool {
    is_package_name(file) || !matches!(PackagePlace::parse(file.into()), Ok(PackagePlace::File(_)))
}

/// The package, and the files of options such as `--dem`, which consume all words that follow them;
/// the package may be among those. `usage` shows how to write it.
///
/// # Errors
/// When no package is named, or the package is ambiguous.
pub(crate) fn package_among<const N: usize>(
    named: Option<&PackagePlace>,
    lists: [&[PathBuf]; N],
    usage: &str,
) -> Result<(PackagePlace, [Vec<PathBuf>; N])> {
    if let Some(package) = named {
        return Ok((package.clone(), lists.map(<[PathBuf]>::to_vec)));
    }
    let mut packages: Vec<PathBuf> = Vec::new();
    let others = lists.map(|files| {
        let (own, others) = files.iter().cloned().partition(|file| may_be_package(file));
        packages.extend::<Vec<PathBuf>>(own);
        others
    });
    match (packages.pop(), packages.is_empty()) {
        (Some(package), true) => Ok((place_of(package)?, others)),
        (Some(_), false) => Err(unusable!(
            "several files have the extension .pmtiles; write the package first: {usage}"
        )),
        (None, _) => Err(unusable!(
            "no package is named: no file has the extension .pmtiles; write the package first: {usage}"
        )),
    }
}

/// The limit is more than most GPUs can draw; each GPU reports its own limit.
pub(crate) fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let sides = text
        .split_once('x')
        .and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
    match sides {
        Some([width @ 1..=16384, height @ 1..=16384]) => Ok([width, height]),
        Some(_) => Err("both sides must be between 1 and 16384 pixels".to_owned()),
        None => Err("write it like 1600x1200".to_owned()),
    }
}

/// Parses a number within a range; the error is the advice.
pub(crate) fn parse_within<T: FromStr + PartialOrd>(
    text: &str,
    range: RangeInclusive<T>,
    advice: &str,
) -> Result<T, String> {
    text.parse().ok().filter(|number| range.contains(number)).ok_or_else(|| advice.to_owned())
}

/// A pixel of these scales and densities is 1 mm to 254 km wide on the ground, which the viewer can
/// draw.
const SCALES: RangeInclusive<u32> = 100..=100_000_000;
const DOTS_PER_INCH: RangeInclusive<f64> = 10.0..=2400.0;

/// The denominator of a scale, from `1:25000` or `25000`.
pub(crate) fn parse_scale(text: &str) -> Result<u32, String> {
    let denominator = text.strip_prefix("1:").unwrap_or(text);
    let advice = "write it like 1:25000, from 1:100 to 1:100000000";
    parse_within(denominator, SCALES, advice)
}

pub(crate) fn parse_dpi(text: &str) -> Result<f64, String> {
    parse_within(text, DOTS_PER_INCH, "write a number of pixels per inch, from 10 to 2400")
}

/// A text that is drawn on an image, on as many lines as it needs.
pub(crate) fn parse_title(text: &str) -> Result<String, String> {
    if text.trim().is_empty() {
        return Err("the title is empty; omit the option for an image without a title".to_owned());
    }
    if text.chars().any(|letter| letter.is_control() || is_unseen(letter)) {
        return Err(
            "the title has invisible characters, such as line breaks; write it in one line"
                .to_owned(),
        );
    }
    Ok(text.trim().to_owned())
}

/// Whether a character only controls how others are written: marks of direction, joiners, spaces
/// without width (category Cf of Unicode 16, as far as texts have them).
fn is_unseen(letter: char) -> bool {
    matches!(letter, '\u{ad}' | '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
}

pub(crate) fn parse_position(text: &str) -> Result<[f64; 2], String> {
    corniche_viewer::parse_lon_lat(text).map_err(|error| error.to_string())
}

#[cfg(test)]
#[path = "values_tests.rs"]
mod tests;
