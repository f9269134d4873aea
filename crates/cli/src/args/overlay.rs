//! `--overlay`: a file of lines and the style of those lines.

use std::path::PathBuf;

use corniche_styles::{Dash, LineStyle, Rgb, Style, parse_color};

use super::values::parse_within;

/// A file of lines that are drawn over the map. On the command line, the file's name may be
/// followed by `,color=COLOUR`, `,width=PX`, `,opacity=SHARE` and `,dash=DASH/GAP` or
/// `,pattern=NAME/PX` in any order.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct OverlayArg {
    pub path: PathBuf,
    /// The colour of the lines, if given.
    pub color: Option<Rgb>,
    width_px: Option<f32>,
    opacity: Option<f32>,
    dash: Option<Dash>,
    /// The text of the command line.
    pub text: String,
}

/// Whether a name of an entry is one of a style. Any other name is a part of the file's name.
fn is_entry(name: &str) -> bool {
    ["color", "width", "opacity", "dash", "pattern"].contains(&name)
}

impl OverlayArg {
    /// The style of the lines; what is not given is as in `usual`.
    pub(crate) fn style(&self, usual: LineStyle) -> LineStyle {
        LineStyle {
            color: self.color.unwrap_or(usual.color),
            width_px: self.width_px.unwrap_or(usual.width_px),
            opacity: self.opacity.unwrap_or(usual.opacity),
            dash: self.dash.unwrap_or(usual.dash),
            ..usual
        }
    }
}

/// The style with the line styles of the overlay files.
pub(crate) fn styled(files: &[OverlayArg], mut style: Style) -> Style {
    for (line, file) in style.overlays.iter_mut().zip(files) {
        *line = file.style(*line);
    }
    style
}

pub(crate) fn parse(text: &str) -> Result<OverlayArg, String> {
    let mut found = OverlayArg {
        path: PathBuf::new(),
        color: None,
        width_px: None,
        opacity: None,
        dash: None,
        text: text.to_owned(),
    };
    let mut rest = text;
    let mut given = Vec::new();
    while let Some((before, entry)) = last_entry(rest)
        && let Some((name, value)) = entry.split_once('=')
        && is_entry(name)
    {
        let number = |range: std::ops::RangeInclusive<f32>| {
            let advice = format!("{name} must be {} to {}", range.start(), range.end());
            parse_within(value, range, &advice)
        };
        if given.contains(&name) {
            return Err(format!("{name} is given twice"));
        }
        given.push(name);
        match name {
            "color" => found.color = Some(parse_color(value).map_err(|error| error.to_string())?),
            "width" => found.width_px = Some(number(0.5..=50.0)?),
            "opacity" => found.opacity = Some(number(0.01..=1.0)?),
            _ if found.dash.is_some() => {
                return Err("use either dash or pattern, not both".to_owned());
            }
            "pattern" => found.dash = Some(pattern(value)?),
            _ => found.dash = Some(dash(value)?),
        }
        rest = before;
    }
    if rest.is_empty() {
        return Err("name a file of lines".to_owned());
    }
    Ok(OverlayArg { path: PathBuf::from(rest), ..found })
}

/// Splits a text at its last comma outside brackets, because colours contain commas in brackets.
fn last_entry(text: &str) -> Option<(&str, &str)> {
    let mut open = 0_usize;
    let comma = text.rfind(|letter| {
        match letter {
            ')' => open += 1,
            '(' => open = open.saturating_sub(1),
            _ => {}
        }
        letter == ',' && open == 0
    })?;
    Some((&text[..comma], &text[comma + 1..]))
}

fn dash(text: &str) -> Result<Dash, String> {
    let lengths: Result<Vec<f32>, _> = text.split('/').map(str::parse).collect();
    let lengths = lengths
        .map_err(|_| format!("{text:?} is not a dash pattern; write pixels like dash=8/4"))?;
    Dash::new(&lengths).map_err(|error| error.to_string())
}

/// Parses a pattern: its name, and its length in pixels.
fn pattern(text: &str) -> Result<Dash, String> {
    let wrong = || format!("{text:?} is not a pattern; write dots/12, beads/16 or arrows/20");
    let (name, length) = text.split_once('/').ok_or_else(wrong)?;
    let length_px = length.parse().map_err(|_| wrong())?;
    let pattern = match name {
        "dots" => Dash::dots(length_px),
        "beads" => Dash::beads(length_px),
        "arrows" => Dash::arrows(length_px),
        _ => return Err(wrong()),
    };
    pattern.map_err(|error| error.to_string())
}

#[cfg(test)]
#[path = "overlay_tests.rs"]
mod tests;
