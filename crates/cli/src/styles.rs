//! Styles by name or path: files are read here, and read again when they change.

use std::{
    io,
    path::{Path, PathBuf},
};

use corniche_styles::{Style, parse_style, style_preset, style_preset_names};

use crate::{
    args::{LookArgs, PackageArg},
    failure::Failure,
    presets::{read_text, refuse, text_of},
};

/// A style that comes with the program by its name, else a file by its path.
pub(crate) fn style(name_or_path: &str) -> Result<Style, Failure> {
    let what = format!("--style {name_or_path} is neither a style that comes along");
    let text = text_of(name_or_path, style_preset(name_or_path), (&what, style_preset_names()))?;
    parse(Path::new(name_or_path), &text)
}

/// The file that `--style` names; `None` for a style that comes with the program.
pub(crate) fn file_of(name_or_path: &str) -> Option<&Path> {
    style_preset(name_or_path).is_none().then_some(Path::new(name_or_path))
}

/// The files that a picture is drawn from: the package, the style if it is a file, and overlays.
pub(crate) fn files_of_look<'a>(look: &'a LookArgs, from: &'a PackageArg) -> Vec<&'a Path> {
    let overlays = look.overlay.iter().map(|file| &*file.path);
    [from.package.name()].into_iter().chain(file_of(&look.style)).chain(overlays).collect()
}

fn parse(path: &Path, text: &str) -> Result<Style, Failure> {
    parse_style(text).map_err(|error| refuse(&format!("style {}", path.display()), &error))
}

/// The file of a style, which is read again and again while a window shows it.
///
/// It has only a few kilobytes, and no time stamp is fine enough to show every change.
#[derive(Debug, Clone)]
pub(crate) struct StyleFile {
    path: PathBuf,
    /// What the file contained, or why it could not be read, when the caller was last told; `None` if that is not known.
    told: Option<Result<String, String>>,
    /// The same at the last look, if it was no style then: perhaps the file was being written.
    doubted: Option<Result<String, String>>,
}

impl StyleFile {
    /// The file behind `--style`; `None` for a style that comes with the program, which never changes.
    pub(crate) fn of(name_or_path: &str) -> Option<Self> {
        let path = file_of(name_or_path)?.to_owned();
        let told = Some(said(&path));
        Some(Self { path, told, doubted: None })
    }

    /// The new style if the file has changed since the caller was last told, or why it contains none. Such an error is
    /// returned once, and only if two looks in a row found the same, because an editor may have emptied the file and not yet
    /// filled it, or be replacing it.
    pub(crate) fn reload_if_changed(&mut self) -> Option<Result<Style, Failure>> {
        let said = said(&self.path);
        let doubted = self.doubted.take();
        if self.told.as_ref() == Some(&said) {
            return None;
        }
        let style = match &said {
            Ok(text) => parse(&self.path, text),
            Err(error) => Err(Failure::unusable(format!("style {}: {error}", self.path.display()))),
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
            "the file is gone; it is read again as soon as there is one at this place".to_owned()
        }
        _ => error.to_string(),
    })
}

#[cfg(test)]
#[path = "styles_tests.rs"]
mod tests;
