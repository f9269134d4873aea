//! Styles by name or path: texts to what the viewer draws with.

use std::{
    fs,
    path::{Path, PathBuf},
    time::SystemTime,
};

use corniche_presets::{
    CenterSheet, Rgb8, RoadSheet, StyleSheet, parse_style, style_preset, style_preset_names,
};
use corniche_viewer::style::{CenterLine, Rgb, RoadStyle, Style, WidthScaling};

use crate::{
    failure::Failure,
    presets::{read_text, refuse},
};

/// A style that comes with the program by its name, else a file by its path.
pub(crate) fn style(name_or_path: &str) -> Result<Style, Failure> {
    match style_preset(name_or_path) {
        Some(text) => parse(&format!("style {name_or_path:?}"), text),
        None => read(Path::new(name_or_path)),
    }
}

/// The file that `--style` names; `None` for a style that comes with the program.
pub(crate) fn file_of(name_or_path: &str) -> Option<&Path> {
    style_preset(name_or_path).is_none().then_some(Path::new(name_or_path))
}

fn read(path: &Path) -> Result<Style, Failure> {
    let text = read_text(path).map_err(|error| {
        let names = style_preset_names().collect::<Vec<_>>().join(", ");
        Failure::unusable(format!(
            "--style {} is neither a style that comes along ({names}) nor a readable file: {error}",
            path.display()
        ))
    })?;
    parse(&format!("style {}", path.display()), &text)
}

fn parse(what: &str, text: &str) -> Result<Style, Failure> {
    parse_style(text).map(|sheet| of_sheet(&sheet)).map_err(|error| refuse(what, &error))
}

/// The file of a style, looked at again and again while a window shows it.
#[derive(Debug, Clone)]
pub(crate) struct StyleFile {
    path: PathBuf,
    /// When it was changed last, as far as is known; `None` while it cannot be told.
    modified: Option<SystemTime>,
}

impl StyleFile {
    /// The file behind `--style`; `None` for a style that comes with the program, which never changes.
    pub(crate) fn of(name_or_path: &str) -> Option<Self> {
        let path = file_of(name_or_path)?.to_owned();
        let modified = modified(&path);
        Some(Self { path, modified })
    }

    /// The style anew when the file has changed since it was last looked at, or why it is none; said once a change. A file
    /// that is away for a moment, as while an editor replaces it, has not changed.
    pub(crate) fn reload_if_changed(&mut self) -> Option<Result<Style, Failure>> {
        let modified = modified(&self.path)?;
        if self.modified.replace(modified) == Some(modified) {
            return None;
        }
        Some(read(&self.path))
    }
}

fn modified(path: &Path) -> Option<SystemTime> {
    fs::metadata(path).and_then(|metadata| metadata.modified()).ok()
}

fn of_sheet(sheet: &StyleSheet) -> Style {
    let StyleSheet { outline_px, width_scaling, light, background, tint, roads } = sheet;
    Style {
        roads: roads.map(road),
        width_scaling: WidthScaling {
            threshold_m: width_scaling.threshold_m as f32,
            exponent: width_scaling.exponent as f32,
            constant: width_scaling.constant as f32,
        },
        outline_px: *outline_px,
        tint: tint.map(|stop| (stop.share as f32, color(stop.color))),
        light_azimuth_deg: light.azimuth_deg,
        light_altitude_deg: light.altitude_deg,
        hillshade: light.hillshade as f32,
        haze: color(background.haze),
        sky: color(background.sky),
        void: color(background.void),
        haze_reach: background.haze_reach as f32,
    }
}

fn road(sheet: RoadSheet) -> RoadStyle {
    RoadStyle {
        width_m: sheet.width_m as f32,
        min_width_px: sheet.min_width_px as f32,
        color: color(sheet.color),
        outline: color(sheet.outline),
        center: sheet.center.map(|CenterSheet { width_share, color: of_center }| CenterLine {
            width_share: width_share as f32,
            color: color(of_center),
        }),
    }
}

fn color(Rgb8(channels): Rgb8) -> Rgb {
    channels.map(|channel| f32::from(channel) / 255.0)
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn the_default_style_is_the_viewers_own() {
        assert_eq!(style("road-atlas").unwrap(), Style::road_atlas());
        assert_ne!(style("dark").unwrap(), Style::road_atlas());
    }

    #[test]
    fn what_is_no_style_is_refused_by_its_name() {
        let message = style("no-such-style").unwrap_err().to_string();
        for word in ["no-such-style", "road-atlas, dark", "No such file"] {
            assert!(message.contains(word), "{word}: {message}");
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mine.toml");
        fs::write(&path, "outline_px = high").unwrap();
        let message = style(path.to_str().unwrap()).unwrap_err().to_string();
        assert!(message.contains("mine.toml") && message.contains("line 1"), "{message}");
    }

    #[test]
    fn a_style_is_read_again_when_its_file_changes_and_only_then() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mine.toml");
        let name = path.to_str().unwrap();
        let write = |text: &str, seconds: u64| {
            fs::write(&path, text).unwrap();
            let time = SystemTime::UNIX_EPOCH + Duration::from_secs(seconds);
            fs::File::options().write(true).open(&path).unwrap().set_modified(time).unwrap();
        };
        write(style_preset("road-atlas").unwrap(), 1000);
        let mut file = StyleFile::of(name).unwrap();
        assert!(file.reload_if_changed().is_none());
        // An older file in its place, as from a backup, is another one too.
        write(style_preset("dark").unwrap(), 500);
        assert_eq!(file.reload_if_changed().unwrap().unwrap(), style("dark").unwrap());
        assert!(file.reload_if_changed().is_none());
        write("outline_px = high", 2000);
        assert!(file.reload_if_changed().unwrap().is_err());
        assert!(file.reload_if_changed().is_none(), "an error is said once");
        fs::remove_file(&path).unwrap();
        assert!(file.reload_if_changed().is_none());
        write(style_preset("dark").unwrap(), 3000);
        assert!(file.reload_if_changed().unwrap().is_ok());
        assert!(StyleFile::of("dark").is_none());
    }
}
