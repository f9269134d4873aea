//! Loads styles by name or path, and reloads style files when they change.

use std::{
    io,
    path::{Path, PathBuf},
};

use corniche_styles::{Style, parse_style, style_preset, style_preset_names};

use crate::{
    args::{LookArgs, PackageArg},
    failure::Result,
    presets::{read_text, refuse, text_of},
};

/// Loads a style: a built-in one by name, or a file by path.
pub(crate) fn style(name_or_path: &str) -> Result<Style> {
    let what = format!("--style {name_or_path:?} is neither a built-in style");
    let text = text_of(name_or_path, style_preset(name_or_path), (&what, style_preset_names()))?;
    parse(Path::new(name_or_path), &text)
}

/// The file that `--style` names; `None` for a built-in style.
pub(crate) fn file_of(name_or_path: &str) -> Option<&Path> {
    style_preset(name_or_path).is_none().then_some(Path::new(name_or_path))
}

/// The input files of an image: the package, the style if it is a file, and overlays.
pub(crate) fn files_of_look<'a>(look: &'a LookArgs, from: &'a PackageArg) -> Vec<&'a Path> {
    let overlays = look.overlay.iter().map(|file| &*file.path);
    [from.package.name()].into_iter().chain(file_of(&look.style)).chain(overlays).collect()
}

fn parse(path: &Path, text: &str) -> Result<Style> {
    parse_style(text).map_err(|error| refuse(&format!("style {path:?}"), &error))
}

/// The file of a style, which is read repeatedly while a window shows it.
///
/// It has only a few kilobytes, and no time stamp is fine enough to show every change.
#[derive(Debug, Clone)]
pub(crate) struct StyleFile {
    path: PathBuf,
    /// The contents of the file, or why it could not be read, at the last report to the caller;
    /// `None` if unknown.
    told: Option<Result<String, String>>,
    /// The contents at the last check, if they were not a valid style: the file may have been
    /// incomplete.
    doubted: Option<Result<String, String>>,
}

impl StyleFile {
    /// The file of `--style`; `None` for a built-in style, which never changes.
    pub(crate) fn find(name_or_path: &str) -> Option<Self> {
        let path = file_of(name_or_path)?.to_owned();
        let told = Some(said(&path));
        Some(Self { path, told, doubted: None })
    }

    /// Returns the new style if the file has changed since the last report to the caller, or why it
    /// is invalid. Such an error is returned once, and only if two consecutive checks found the
    /// same contents, because an editor may have truncated the file before writing it, or be
    /// replacing it.
    pub(crate) fn reload_if_changed(&mut self) -> Option<Result<Style>> {
        let said = said(&self.path);
        let doubted = self.doubted.take();
        if self.told.as_ref() == Some(&said) {
            return None;
        }
        let style = match &said {
            Ok(text) => parse(&self.path, text),
            Err(error) => Err(unusable!("style {:?}: {error}", self.path)),
        };
        if style.is_err() && doubted.as_ref() != Some(&said) {
            self.doubted = Some(said);
            return None;
        }
        self.told = Some(said);
        Some(style)
    }
}

/// The text of a file, or why it cannot be read.
fn said(path: &Path) -> Result<String, String> {
    read_text(path).map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => {
            "the file is missing; it is read again as soon as it exists".to_owned()
        }
        _ => error.to_string(),
    })
}

#[cfg(test)]
#[path = "styles_tests.rs"]
mod tests;
