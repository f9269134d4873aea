//! The `[layers]` and `[layer_defaults]` parts of a style's text.

use std::collections::BTreeMap;

use corniche_layers::LayerGeometry;
use serde::Deserialize;

use crate::{
    Dash, Rgb, StyleError,
    layer_looks::{LayerLooks, LookEntries},
    sheet_values::{Rgb8, number},
};

/// The entries of a layer, of one of its classes, or of a geometry.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LookSheet {
    /// Colour.
    color: Option<Rgb8>,
    /// How much of the map is hidden, 0 to 1; 0 draws nothing.
    opacity: Option<f64>,
    /// Areas: ground steeper than this is not painted, 1 to 89 degrees.
    steepest_deg: Option<f64>,
    /// Lines: the width on the picture, 0.5 to 50 pixels.
    width_px: Option<f64>,
    /// Lines: the colour of an edge of one pixel on both sides.
    casing: Option<Rgb8>,
    /// Lines: dash and gap in pixels, optionally followed by a second dash and gap; none for a
    /// solid line.
    dash: Option<Vec<f32>>,
    /// Lines: the width along a pattern; not allowed together with `dash`.
    pattern: Option<PatternSheet>,
    /// Lines: whether they are omitted close to roads.
    apart_from_roads: Option<bool>,
    /// Points: the diameter of a mark on the picture, 1 to 100 pixels.
    size_px: Option<f64>,
    /// Points: the colour of an edge of one pixel.
    outline: Option<Rgb8>,
    /// Lines and points: they are fully drawn up to this many metres of ground per pixel, 0.01 to
    /// 1e6.
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

/// The classes of a layer by id; the entries of the layer itself have an empty id.
pub(crate) type ClassSheets = BTreeMap<String, LookSheet>;

/// The looks of layers, by the ids of layers and classes.
pub(crate) fn layer_looks(
    defaults: &BTreeMap<String, LookSheet>,
    layers: &BTreeMap<String, ClassSheets>,
) -> Result<LayerLooks, StyleError> {
    let mut looks = LayerLooks::default();
    for (name, sheet) in defaults {
        let path = format!("layer_defaults.{name}");
        let geometry = LayerGeometry::ALL.into_iter().find(|geometry| geometry.name() == name);
        let Some(geometry) = geometry else {
            return Err(StyleError::LayerDefaults { text: name.clone() });
        };
        check_geometry(&path, std::iter::once(sheet), Some(geometry))?;
        looks.defaults.insert(geometry.name().to_owned(), sheet.checked(&path)?);
    }
    for (layer, classes) in layers {
        let path = format!("layers.{layer}");
        check_geometry(&path, classes.values(), None)?;
        let mut entries = BTreeMap::new();
        for (class, sheet) in classes {
            let path = if class.is_empty() { path.clone() } else { format!("{path}.{class}") };
            if !is_id(layer) || !(class.is_empty() || is_id(class)) {
                return Err(StyleError::LayerId { path });
            }
            entries.insert(class.clone(), sheet.checked(&path)?);
        }
        looks.layers.insert(layer.clone(), entries);
    }
    Ok(looks)
}

/// Whether a text has the form of the ids of layers and classes.
fn is_id(text: &str) -> bool {
    let is_plain = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'-';
    text.as_bytes().first().is_some_and(u8::is_ascii_lowercase)
        && text.len() <= 32
        && text.bytes().all(is_plain)
        && !text.ends_with('-')
}

/// Refuses entries that belong to different geometries.
fn check_geometry<'a>(
    path: &str,
    sheets: impl Iterator<Item = &'a LookSheet>,
    geometry: Option<LayerGeometry>,
) -> Result<(), StyleError> {
    let mut first = geometry.map(|geometry| ("", geometry));
    for (entry, geometry) in sheets.flat_map(LookSheet::entries_of_geometry) {
        let (other, expected) = *first.get_or_insert((entry, geometry));
        if expected != geometry {
            let path = path.to_owned();
            return Err(StyleError::LayerGeometry { path, entry, geometry, other, expected });
        }
    }
    Ok(())
}

impl LookSheet {
    /// The entries that only one geometry has.
    fn entries_of_geometry(&self) -> impl Iterator<Item = (&'static str, LayerGeometry)> {
        use LayerGeometry::{Area, Line, Point};
        [
            ("steepest_deg", Area, self.steepest_deg.is_some()),
            ("width_px", Line, self.width_px.is_some()),
            ("casing", Line, self.casing.is_some()),
            ("dash", Line, self.dash.is_some()),
            ("pattern", Line, self.pattern.is_some()),
            ("apart_from_roads", Line, self.apart_from_roads.is_some()),
            ("size_px", Point, self.size_px.is_some()),
            ("outline", Point, self.outline.is_some()),
        ]
        .into_iter()
        .filter_map(|(entry, geometry, is_given)| is_given.then_some((entry, geometry)))
    }

    fn dash(&self) -> Result<Option<Dash>, StyleError> {
        match (&self.dash, &self.pattern) {
            (None, None) => Ok(None),
            (Some(lengths_px), None) => Dash::new(lengths_px).map(Some),
            (None, Some(pattern)) => Dash::textured(pattern.length_px, &pattern.widths).map(Some),
            (Some(_), Some(_)) => Err(StyleError::DashAndPattern),
        }
    }

    /// The entries, if every number is within its range.
    fn checked(&self, path: &str) -> Result<LookEntries, StyleError> {
        let number = |name, value, range| number(&format!("{path}.{name}"), value, range);
        Ok(LookEntries {
            color: self.color.map(Rgb::from),
            opacity: number("opacity", self.opacity, 0.0..=1.0)?,
            steepest_deg: number("steepest_deg", self.steepest_deg, 1.0..=89.0)?,
            width_px: number("width_px", self.width_px, 0.5..=50.0)?,
            casing: self.casing.map(Rgb::from),
            dash: self.dash()?,
            is_apart_from_roads: self.apart_from_roads,
            size_px: number("size_px", self.size_px, 1.0..=100.0)?,
            outline: self.outline.map(Rgb::from),
            max_pixel_m: number("max_pixel_m", self.max_pixel_m, 0.01..=1e6)?,
        })
    }
}

#[cfg(test)]
#[path = "layer_sheet_tests.rs"]
mod tests;
