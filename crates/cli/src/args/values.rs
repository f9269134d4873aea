//! Texts of single values.

use std::{ffi::OsStr, path::PathBuf};

use clap::{builder::TypedValueParser, error::ErrorKind};
use corniche_remote::PackagePlace;

use crate::failure::Failure;

/// The package that a command reads: a file, or an address on a web server.
pub(crate) fn package_place() -> impl TypedValueParser<Value = PackagePlace> {
    PlaceParser
}

/// Reads where a package is. What cannot be read is not repeated in the message, as parsers of clap's own do: an address may hold a password.
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

/// The package that one of several files is.
///
/// # Errors
/// When it is an address that cannot be read.
pub(crate) fn place_of(file: PathBuf) -> Result<PackagePlace, Failure> {
    PackagePlace::parse(file.into()).map_err(Failure::unusable)
}

/// More than most graphics cards can draw; each says itself what it can.
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

pub(crate) fn parse_position(text: &str) -> Result<[f64; 2], String> {
    corniche_viewer::parse_lon_lat(text).map_err(|error| error.to_string())
}

#[cfg(test)]
#[path = "values_tests.rs"]
mod tests;
