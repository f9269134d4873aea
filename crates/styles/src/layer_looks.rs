//! How the layers of a package look: what a style says of layers and classes, by their ids.

use std::collections::BTreeMap;

use corniche_layers::{LayerForm, LayerGeometry};
use serde::{Deserialize, Serialize};

use crate::{AreaStyle, Dash, LineStyle, PointStyle, Rgb};

/// The side of a pixel at the scales of tables, metres: 1/96 inch.
const PIXEL_M: f64 = 0.0254 / 96.0;

/// How the objects of one class of a layer are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LayerLook {
    /// A class of areas.
    Area(AreaStyle),
    /// A class of lines.
    Line(LineStyle),
    /// A class of points.
    Point(PointStyle),
}

impl LayerLook {
    /// The colour.
    #[must_use]
    pub fn color(&self) -> Rgb {
        match self {
            Self::Area(AreaStyle { color, .. })
            | Self::Line(LineStyle { color, .. })
            | Self::Point(PointStyle { color, .. }) => *color,
        }
    }

    /// The same look with another opacity; 0 draws nothing.
    #[must_use]
    pub fn with_opacity(self, opacity: f32) -> Self {
        match self {
            Self::Area(area) => Self::Area(AreaStyle { opacity, ..area }),
            Self::Line(line) => Self::Line(LineStyle { opacity, ..line }),
            Self::Point(point) => Self::Point(PointStyle { opacity, ..point }),
        }
    }

    /// Whether anything of the class is drawn.
    #[must_use]
    pub fn is_drawn(&self) -> bool {
        let (Self::Area(AreaStyle { opacity, .. })
        | Self::Line(LineStyle { opacity, .. })
        | Self::Point(PointStyle { opacity, .. })) = self;
        *opacity > 0.0
    }
}

/// The looks of layers in a style.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct LayerLooks {
    /// What applies where neither a class nor its layer says more, by the name of the geometry.
    pub(crate) defaults: BTreeMap<String, LookEntries>,
    /// For each layer its classes; the entries of the layer itself have an empty id.
    pub(crate) layers: BTreeMap<String, BTreeMap<String, LookEntries>>,
}

/// What a style says of a class, of a layer or of a geometry.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct LookEntries {
    pub(crate) color: Option<Rgb>,
    pub(crate) opacity: Option<f32>,
    pub(crate) steepest_deg: Option<f32>,
    pub(crate) width_px: Option<f32>,
    pub(crate) casing: Option<Rgb>,
    pub(crate) dash: Option<Dash>,
    pub(crate) is_apart_from_roads: Option<bool>,
    pub(crate) size_px: Option<f32>,
    pub(crate) outline: Option<Rgb>,
    pub(crate) max_pixel_m: Option<f32>,
}

impl LookEntries {
    /// These entries, and those of `other` where there are none.
    fn or(self, other: &Self) -> Self {
        Self {
            color: self.color.or(other.color),
            opacity: self.opacity.or(other.opacity),
            steepest_deg: self.steepest_deg.or(other.steepest_deg),
            width_px: self.width_px.or(other.width_px),
            casing: self.casing.or(other.casing),
            dash: self.dash.or(other.dash),
            is_apart_from_roads: self.is_apart_from_roads.or(other.is_apart_from_roads),
            size_px: self.size_px.or(other.size_px),
            outline: self.outline.or(other.outline),
            max_pixel_m: self.max_pixel_m.or(other.max_pixel_m),
        }
    }

    fn look(self, geometry: LayerGeometry) -> LayerLook {
        let color = self.color.unwrap_or_default();
        let opacity = self.opacity.unwrap_or(1.0);
        let Self { steepest_deg, casing, outline, max_pixel_m, .. } = self;
        match geometry {
            LayerGeometry::Area => LayerLook::Area(AreaStyle { color, opacity, steepest_deg }),
            LayerGeometry::Line => LayerLook::Line(LineStyle {
                color,
                width_px: self.width_px.unwrap_or(1.0),
                casing,
                opacity,
                dash: self.dash.unwrap_or(Dash::SOLID),
                max_pixel_m,
                is_apart_from_roads: self.is_apart_from_roads.unwrap_or(false),
            }),
            LayerGeometry::Point => {
                let size_px = self.size_px.unwrap_or(5.0);
                LayerLook::Point(PointStyle { color, size_px, outline, opacity, max_pixel_m })
            }
        }
    }
}

impl LayerLooks {
    /// How the class with this number in the table of a layer is drawn; see
    /// [`Style::layer_look`](crate::Style::layer_look).
    pub(crate) fn look(&self, layer: &LayerForm, class: usize) -> LayerLook {
        let class = layer.classes.get(class);
        let entries = self.layers.get(&layer.id);
        let entry = |id: &str| entries.and_then(|entries| entries.get(id));
        let scale = class.and_then(|class| class.scale);
        let max_pixel_m = scale.map(|scale| (scale * PIXEL_M) as f32);
        let of_scale = LookEntries { max_pixel_m, ..LookEntries::default() };
        [class.and_then(|class| entry(&class.id)), entry(""), Some(&of_scale)]
            .into_iter()
            .chain([self.defaults.get(layer.geometry.name())])
            .flatten()
            .fold(LookEntries::default(), LookEntries::or)
            .look(layer.geometry)
    }
}

/// The built-in table of a layer.
#[cfg(test)]
pub(crate) fn built_in_layer(id: &str) -> LayerForm {
    let table = corniche_config::LAYERS.iter().find(|(name, _)| *name == id);
    toml::from_str(table.map_or("", |(_, text)| text)).unwrap_or_else(|error| panic!("{error}"))
}

#[cfg(test)]
#[path = "layer_looks_tests.rs"]
mod tests;
