//! The `[boundaries]` part of a style's text.

use std::collections::BTreeMap;

use corniche_areas::BoundaryClass;
use serde::Deserialize;

use crate::{
    Dash, LineStyle, Rgb, StyleError,
    sheet_values::{Rgb8, within},
};

/// How the boundaries of one class are drawn.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LineSheet {
    /// Colour.
    color: Rgb8,
    /// Width of the line on the picture, 0.5 to 50 pixels.
    width_px: f64,
    /// Colour of an edge of one pixel on both sides. Default: no edge.
    casing: Option<Rgb8>,
    /// How much of the map the line hides, 0 to 1; 0 does not draw the class. Default: 1.
    opacity: Option<f64>,
    /// Dash and gap in pixels, optionally followed by a second dash and gap. Default: a solid line.
    #[serde(default)]
    dash: Vec<f32>,
    /// The width along a pattern; not allowed together with `dash`.
    pattern: Option<PatternSheet>,
    /// The line is fully drawn up to this many metres of ground per pixel, 0.01 to 1e6. Default:
    /// always.
    max_pixel_m: Option<f64>,
}

/// A pattern along a line, like a texture with one row.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct PatternSheet {
    /// Length of the pattern on the picture, 2 to 800 pixels.
    length_px: f32,
    /// 1 to 16 shares of the line's width, at equal distances.
    widths: Vec<f32>,
}

impl LineSheet {
    fn pattern(&self) -> Result<Dash, StyleError> {
        match &self.pattern {
            None => Dash::new(&self.dash),
            Some(_) if !self.dash.is_empty() => Err(StyleError::DashAndPattern),
            Some(PatternSheet { length_px, widths }) => Dash::textured(*length_px, widths),
        }
    }
}

/// Returns the boundary styles by class. A complete style defines every class.
pub(crate) fn boundaries(
    sheets: &BTreeMap<String, LineSheet>,
) -> Result<[LineStyle; LineStyle::MOST], StyleError> {
    let mut styles = [LineStyle::NOTHING; LineStyle::MOST];
    for (name, sheet) in sheets {
        let Some(class) = BoundaryClass::from_name(name) else {
            return Err(StyleError::BoundaryClass { text: name.clone() });
        };
        let entry = |of| format!("boundaries.{name}.{of}");
        within(&entry("width_px"), sheet.width_px, 0.5..=50.0)?;
        let opacity = sheet.opacity.unwrap_or(1.0);
        within(&entry("opacity"), opacity, 0.0..=1.0)?;
        if let Some(max_pixel_m) = sheet.max_pixel_m {
            within(&entry("max_pixel_m"), max_pixel_m, 0.01..=1e6)?;
        }
        styles[usize::from(class.number())] = LineStyle {
            color: sheet.color.into(),
            width_px: sheet.width_px as f32,
            casing: sheet.casing.map(Rgb::from),
            opacity: opacity as f32,
            dash: sheet.pattern()?,
            max_pixel_m: sheet.max_pixel_m.map(|max_pixel_m| max_pixel_m as f32),
        };
    }
    Ok(styles)
}
