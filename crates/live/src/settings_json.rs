//! Settings of a map as JSON: what a page can change.

use corniche_roads::FunctionalRoadClass;
use corniche_viewer::{
    ClassSet, OutOfRange, RoadMethod, RoadOptions, RoadOutline, ShownLayers, range,
};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::settings::{Compare, MapSettings};

/// Settings to change; omitted settings stay unchanged.
pub type SettingChanges = Map<String, Value>;

/// Settings for which `null` is a value. For others, `null` means unchanged.
const WITH_NULL: [&str; 3] = ["photo", "layers", "cell_px"];

/// All settings that a page can change.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoredSettings {
    /// The drawing method of roads, if one method is shown.
    pub roads: RoadMethod,
    /// Whether one method is shown, or both are compared.
    pub compare: Compare,
    /// The position of the divider, as a share of the canvas's width.
    pub divider: f32,
    /// Whether each class is drawn, class 0 first.
    pub classes: [bool; FunctionalRoadClass::COUNT],
    /// Factors on the style's widths, class 0 first.
    pub widths: [f32; FunctionalRoadClass::COUNT],
    /// The edge around roads.
    pub outline: RoadOutline,
    /// The name of a bundled style, or the address of a custom style that the page keeps.
    pub style: String,
    /// The opacity of photos, 0 to 1; `None` for that of the style.
    pub photo: Option<f32>,
    /// The ids of the layers that are drawn; `None` for all.
    pub layers: ShownLayers,
    /// Factor on heights; 1 is true.
    pub exaggeration: f64,
    /// A tile is refined while its error looks larger than this, pixels.
    pub error_px: f64,
    /// A tile is refined while one of its cells looks larger than this, pixels; `None` for no
    /// limit.
    pub cell_px: Option<f64>,
    /// Samples per pixel along each side.
    pub samples: u32,
    /// Whether the edges of triangles are drawn.
    pub wireframe: bool,
    /// Whether movements slow down gradually.
    pub inertia: bool,
}

impl Default for StoredSettings {
    /// The settings of `corniche render` without options.
    fn default() -> Self {
        Self {
            roads: RoadMethod::Geometry,
            compare: Compare::Off,
            divider: 0.5,
            classes: [true; FunctionalRoadClass::COUNT],
            widths: [1.0; FunctionalRoadClass::COUNT],
            outline: RoadOutline::OfStyle,
            style: "road-atlas".to_owned(),
            photo: None,
            layers: ShownLayers::ALL,
            exaggeration: 1.0,
            error_px: 2.0,
            cell_px: Some(2.0),
            samples: 2,
            wireframe: false,
            inertia: true,
        }
    }
}

impl StoredSettings {
    /// Returns these settings with some of them changed by a JSON object with the fields to change.
    ///
    /// # Errors
    /// When the text is not an object of settings or a value is out of range, as a message.
    pub fn changed_by(&self, changes: &str) -> Result<Self, String> {
        let changes = serde_json::from_slice(changes.as_bytes());
        self.changed(changes.map_err(|error| format!("settings: {error}"))?)
    }

    /// Applies changes that were parsed already.
    ///
    /// # Errors
    /// When there is no such setting or a value is out of range, as a message.
    pub fn changed(&self, mut changes: SettingChanges) -> Result<Self, String> {
        let told = |error: serde_json::Error| format!("settings: {error}");
        let mut all = serde_json::to_value(self).map_err(told)?;
        if let Value::Object(all) = &mut all {
            // An unknown name stays in the object, so that it is rejected with or without a value.
            changes.retain(|name, value| {
                !value.is_null() || WITH_NULL.contains(&name.as_str()) || !all.contains_key(name)
            });
            all.extend(changes);
        }
        let changed: Self = serde_json::from_value(all).map_err(told)?;
        changed.check()?;
        Ok(changed)
    }

    fn check(&self) -> Result<(), String> {
        let told = |error: OutOfRange| error.to_string();
        let cell_px = self.cell_px.unwrap_or(f64::INFINITY);
        range::check_ground(self.error_px, cell_px, self.exaggeration).map_err(told)?;
        range::check_supersampling(self.samples).map_err(told)?;
        let photo = self.photo.unwrap_or(0.0);
        for (name, share) in [("a divider", self.divider), ("a photo", photo)] {
            range::within(name, share.into(), 0.0..=1.0, "0 to 1").map_err(told)?;
        }
        for factor in self.widths {
            range::within("a width factor", factor.into(), 0.01..=100.0, "0.01 to 100")
                .map_err(told)?;
        }
        Ok(())
    }

    /// The same settings for a session.
    #[must_use]
    pub fn of_session(&self) -> MapSettings {
        let all = FunctionalRoadClass::all().zip(self.classes);
        let shown = all.filter_map(|(class, is_shown)| is_shown.then_some(class));
        let roads = RoadOptions {
            classes: shown.collect::<ClassSet>(),
            outline: self.outline,
            ..RoadOptions::for_method(self.roads)
        };
        MapSettings {
            compare: self.compare,
            divider_share: self.divider,
            width_factors: self.widths,
            photo: self.photo,
            layers: self.layers.clone(),
            exaggeration: self.exaggeration,
            screen_space_error_px: self.error_px,
            cell_px: self.cell_px.unwrap_or(f64::INFINITY),
            samples_per_side: self.samples,
            is_wireframe: self.wireframe,
            ..MapSettings::usual(roads)
        }
    }
}

#[cfg(test)]
#[path = "settings_json_tests.rs"]
mod tests;
