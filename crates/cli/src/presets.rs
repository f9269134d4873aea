//! Loads presets by name and settings files by path, and passes their text to
//! `corniche-presets`.

use std::{
    borrow::Cow,
    fs,
    io::{self, Read as _},
    path::Path,
};

use corniche_presets::{
    Config, class_labels as preset_labels, frc_preset, frc_preset_names, parse_frc_table,
};
use corniche_roads::{FrcTable, FunctionalRoadClass};
use corniche_tileset::Manifest;
use strsim::levenshtein;

use crate::failure::{CommandFailure, Result};

/// The largest size of a settings file; real ones are far smaller.
const MAX_FILE_BYTES: u64 = 2 << 20;

/// A text is taken for a misspelt name if it differs from it by at most this many letters.
const MOST_CHANGES: usize = 2;

/// Loads an FRC table: a preset by name, or a file by path.
pub(crate) fn frc_table(name_or_path: &str) -> Result<FrcTable> {
    let what = format!("--frc-table {name_or_path:?} is neither a preset");
    let text = text_of(name_or_path, frc_preset(name_or_path), (&what, frc_preset_names()))?;
    let table = parse_frc_table(&text)
        .map_err(|error| refuse(&format!("FRC table {name_or_path:?}"), &error))?;
    // For a preset, or a copy of one, the name is sufficient.
    let is_known = preset_labels(table.name()) == table.class_labels();
    Ok(if is_known { table } else { table.with_recorded_labels() })
}

/// The text of a preset by name, or of a file by path. The error begins with `what`, lists all
/// presets, and suggests one with a similar name.
pub(crate) fn text_of(
    path: &str,
    preset: Option<&'static str>,
    (what, names): (&str, impl Iterator<Item = &'static str>),
) -> Result<Cow<'static, str>> {
    if let Some(text) = preset {
        return Ok(text.into());
    }
    read_text(Path::new(path)).map(Cow::Owned).map_err(|error| {
        let names: Vec<&str> = names.collect();
        let near = names.iter().map(|name| (levenshtein(name, path), name));
        let near = near.filter(|(changes, _)| *changes <= MOST_CHANGES).min();
        let meant = near.map_or_else(String::new, |(_, name)| format!("; did you mean {name}?"));
        unusable!("{what} ({}) nor a readable file: {error}{meant}", names.join(", "))
    })
}

/// The built-in FRC table of a package; `None` if it was built with another one.
pub(crate) fn recorded_table(manifest: &Manifest) -> Option<FrcTable> {
    let settings = &manifest.settings;
    let text = frc_preset(&settings.frc_table).filter(|_| settings.recorded_labels().is_none());
    text.and_then(|text| parse_frc_table(text).ok())
}

/// The labels of the road classes of a package: the recorded ones, or those of the table with the
/// recorded name.
pub(crate) fn class_labels(manifest: &Manifest) -> [String; FunctionalRoadClass::COUNT] {
    let settings = &manifest.settings;
    settings.recorded_labels().unwrap_or_else(|| preset_labels(&settings.frc_table))
}

/// Reads a settings file.
pub(crate) fn read_config(path: &Path) -> Result<Config> {
    let text = read_text(path)
        .map_err(|error| unusable!("cannot read the settings file {path:?}: {error}"))?;
    Config::parse(&text).map_err(|error| refuse(&format!("settings file {path:?}"), &error))
}

pub(crate) fn refuse(what: &str, error: &dyn std::error::Error) -> CommandFailure {
    let said = error.to_string();
    // TOML's error draws the position between its line and its reason; a message is one line.
    let is_drawn = |line: &&str| {
        line.trim_start_matches(|c: char| c == ' ' || c.is_ascii_digit()).starts_with('|')
    };
    let said: Vec<&str> = said.lines().filter(|line| !is_drawn(line)).collect();
    unusable!("{what}: {}", said.join(": "))
}

pub(crate) fn read_text(path: &Path) -> io::Result<String> {
    refuse_stream(path)?;
    let mut text = String::new();
    fs::File::open(path)?.take(MAX_FILE_BYTES).read_to_string(&mut text)?;
    Ok(text)
}

/// Rejects streams. Opening a pipe blocks until another program writes into it, and texts are read
/// again when they change.
pub(crate) fn refuse_stream(path: &Path) -> io::Result<()> {
    if fs::metadata(path)?.file_type().is_file() {
        Ok(())
    } else if path.is_dir() {
        Err(io::ErrorKind::IsADirectory.into())
    } else {
        Err(io::Error::other("it is a pipe or a device; save it to a file first"))
    }
}
