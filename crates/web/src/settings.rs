//! What a page can change of a map, as JSON.

use corniche_roads::FunctionalRoadClass;
use corniche_styles::Style;
use corniche_viewer::{ClassSet, Outline, RoadMethod, RoadOptions, Wireframe, range};
use serde::{Deserialize, Deserializer, Serialize};

use crate::tables;

/// How roads are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Roads {
    Geo,
    Sv,
    None,
}

/// Whether one method is shown, or both are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Compare {
    Off,
    /// GEO to the left of a divider, SV to the right.
    Split,
    /// Where GEO and SV show different classes.
    Difference,
}

/// The edge around roads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Edge {
    #[serde(rename = "style")]
    Style,
    #[serde(rename = "none")]
    None,
    #[serde(rename = "3")]
    Kernel3,
    #[serde(rename = "5")]
    Kernel5,
}

/// Everything that a page can change.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "they are boxes to tick, independent of each other"
)]
pub(crate) struct Settings {
    pub(crate) roads: Roads,
    pub(crate) compare: Compare,
    /// Position of the divider, as a share of the canvas's width.
    pub(crate) divider: f32,
    /// Which classes are drawn, 0 first.
    pub(crate) classes: [bool; FunctionalRoadClass::COUNT],
    /// Factors on the style's widths, class 0 first.
    pub(crate) widths: [f32; FunctionalRoadClass::COUNT],
    pub(crate) outline: Edge,
    /// The name of a style that comes with the program, or the address of an own one that the page keeps.
    pub(crate) style: String,
    /// How strongly photos are seen, 0 to 1; `None`: as the style says.
    pub(crate) photo: Option<f32>,
    pub(crate) areas: bool,
    pub(crate) boundaries: bool,
    pub(crate) exaggeration: f64,
    /// A tile is refined while its error looks larger than this, pixels.
    pub(crate) error_px: f64,
    /// A tile is refined while one of its cells looks larger than this, pixels; `None`: cells do not count.
    pub(crate) cell_px: Option<f64>,
    /// Samples per pixel along each side.
    pub(crate) samples: u32,
    pub(crate) wireframe: bool,
    /// Whether movements slow down gradually.
    pub(crate) inertia: bool,
}

/// Settings to change; those that are left out stay as they are.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[expect(clippy::option_option, reason = "JSON has a field with a value, one with null, and none")]
pub(crate) struct Changes {
    roads: Option<Roads>,
    compare: Option<Compare>,
    divider: Option<f32>,
    classes: Option<[bool; FunctionalRoadClass::COUNT]>,
    widths: Option<[f32; FunctionalRoadClass::COUNT]>,
    outline: Option<Edge>,
    style: Option<String>,
    #[serde(deserialize_with = "said")]
    photo: Option<Option<f32>>,
    areas: Option<bool>,
    boundaries: Option<bool>,
    exaggeration: Option<f64>,
    error_px: Option<f64>,
    #[serde(deserialize_with = "said")]
    cell_px: Option<Option<f64>>,
    samples: Option<u32>,
    wireframe: Option<bool>,
    inertia: Option<bool>,
}

/// A value that is there, `null` among them.
#[expect(clippy::option_option, reason = "as the fields that it reads")]
fn said<'de, D: Deserializer<'de>, T: Deserialize<'de>>(
    deserializer: D,
) -> Result<Option<Option<T>>, D::Error> {
    Option::<T>::deserialize(deserializer).map(Some)
}

impl Default for Settings {
    /// The settings with which `corniche render` draws without options.
    fn default() -> Self {
        Self {
            roads: Roads::Geo,
            compare: Compare::Off,
            divider: 0.5,
            classes: [true; FunctionalRoadClass::COUNT],
            widths: [1.0; FunctionalRoadClass::COUNT],
            outline: Edge::Style,
            style: "road-atlas".to_owned(),
            photo: None,
            areas: true,
            boundaries: true,
            exaggeration: 1.0,
            error_px: 2.0,
            cell_px: Some(2.0),
            samples: 2,
            wireframe: false,
            inertia: true,
        }
    }
}

impl Settings {
    /// These settings with some of them changed: a JSON object with the fields to change.
    ///
    /// # Errors
    /// In words, when the text is no such object or a value is out of its range.
    pub(crate) fn changed_by(&self, changes: &str) -> Result<Self, String> {
        let changes: Changes = serde_json::from_slice(changes.as_bytes())
            .map_err(|error| format!("settings: {error}"))?;
        self.changed(&changes)
    }

    /// The same of changes that were read already.
    ///
    /// # Errors
    /// In words, when a value is out of its range.
    pub(crate) fn changed(&self, changes: &Changes) -> Result<Self, String> {
        let changed = self.with(changes);
        changed.check()?;
        Ok(changed)
    }

    /// These settings with some of them changed, unchecked.
    fn with(&self, changes: &Changes) -> Self {
        Self {
            roads: changes.roads.unwrap_or(self.roads),
            compare: changes.compare.unwrap_or(self.compare),
            divider: changes.divider.unwrap_or(self.divider),
            classes: changes.classes.unwrap_or(self.classes),
            widths: changes.widths.unwrap_or(self.widths),
            outline: changes.outline.unwrap_or(self.outline),
            style: changes.style.clone().unwrap_or_else(|| self.style.clone()),
            photo: changes.photo.unwrap_or(self.photo),
            areas: changes.areas.unwrap_or(self.areas),
            boundaries: changes.boundaries.unwrap_or(self.boundaries),
            exaggeration: changes.exaggeration.unwrap_or(self.exaggeration),
            error_px: changes.error_px.unwrap_or(self.error_px),
            cell_px: changes.cell_px.unwrap_or(self.cell_px),
            samples: changes.samples.unwrap_or(self.samples),
            wireframe: changes.wireframe.unwrap_or(self.wireframe),
            inertia: changes.inertia.unwrap_or(self.inertia),
        }
    }

    fn check(&self) -> Result<(), String> {
        let told = |error: corniche_viewer::OutOfRange| error.to_string();
        let cell_px = self.cell_px.unwrap_or(f64::INFINITY);
        range::check_ground(self.error_px, cell_px, self.exaggeration).map_err(told)?;
        range::check_supersampling(self.samples).map_err(told)?;
        range::within("a divider", self.divider.into(), 0.0..=1.0, "0 to 1").map_err(told)?;
        range::within("a photo", self.photo.unwrap_or(0.0).into(), 0.0..=1.0, "0 to 1")
            .map_err(told)?;
        for factor in self.widths {
            range::within("a width factor", factor.into(), 0.01..=100.0, "0.01 to 100")
                .map_err(told)?;
        }
        self.look().map(|_| ())
    }

    /// The style as it is drawn.
    ///
    /// # Errors
    /// In words, when there is no such style.
    pub(crate) fn look(&self) -> Result<Style, String> {
        let mut style = tables::style(&self.style).ok_or_else(|| {
            let names = tables::style_names().join(", ");
            format!("there is no style {:?}; there are {names}", self.style)
        })?;
        style.photo = self.photo.unwrap_or(style.photo);
        if !self.areas {
            style = style.without_areas();
        }
        if !self.boundaries {
            style = style.without_boundaries();
        }
        for (road, factor) in style.roads.iter_mut().zip(self.widths) {
            *road = road.widened(factor);
        }
        Ok(style)
    }

    /// The method, if one is shown.
    fn method(&self) -> RoadMethod {
        match self.roads {
            Roads::Geo => RoadMethod::Geometry,
            Roads::Sv => RoadMethod::ShadowVolumes,
            Roads::None => RoadMethod::None,
        }
    }

    /// How roads are drawn, by the method that is shown.
    pub(crate) fn road_options(&self) -> RoadOptions {
        let all = FunctionalRoadClass::all().zip(self.classes);
        RoadOptions {
            classes: all
                .filter_map(|(class, is_shown)| is_shown.then_some(class))
                .collect::<ClassSet>(),
            outline: match self.outline {
                Edge::Style => Outline::OfStyle,
                Edge::None => Outline::None,
                Edge::Kernel3 => Outline::Kernel3,
                Edge::Kernel5 => Outline::Kernel5,
            },
            ..RoadOptions::of(self.method())
        }
    }

    /// The options of the roads for each picture: one picture, or GEO and SV.
    pub(crate) fn pictures(&self) -> Vec<RoadOptions> {
        let roads = self.road_options();
        match self.compare {
            Compare::Off => vec![roads],
            Compare::Split | Compare::Difference => {
                [RoadMethod::Geometry, RoadMethod::ShadowVolumes]
                    .map(|method| RoadOptions { method, ..roads })
                    .into()
            }
        }
    }

    /// Whether the edges of triangles are drawn, in the viewer's words.
    pub(crate) fn edges(&self) -> Wireframe {
        if self.wireframe { Wireframe::Shown } else { Wireframe::Hidden }
    }
}

#[cfg(test)]
#[path = "settings_tests.rs"]
mod tests;
