//! The TOML text of a style: it is checked entry by entry, then converted to the values that the
//! viewer draws with.

use std::{collections::BTreeMap, sync::LazyLock};

use corniche_roads::FunctionalRoadClass;
use serde::Deserialize;

use crate::{
    LineStyle, OwnWidths, RoadStyle, Style, StyleError, WidthScaling,
    base::{self, USUAL},
    ground_sheet::{LightSheet, TintSheet, tint},
    layer_sheet::{ClassSheets, LookSheet, layer_looks},
    road_sheet::RoadSheet,
    sheet_values::{Rgb8, within},
    style_preset,
};

/// Maximum length of a style's text. The longest preset has some 3 kB.
const MAX_TEXT_BYTES: usize = 1 << 20;

/// How roads widen with distance.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct WidthScalingSheet {
    /// Up to this distance from the eye, roads have their true width, 1 to 1e7 m.
    threshold_m: f64,
    /// Exponent of the growth with distance, 0 to 1.
    exponent: f64,
    /// Factor on all widths where they are multiplied by a constant, 0.1 to 100.
    constant: f64,
}

/// Colours where there is no near ground.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct BackgroundSheet {
    /// Colour of far ground and of the sky at the horizon.
    haze: Rgb8,
    /// Colour of the sky far above the horizon.
    sky: Rgb8,
    /// Colour below the horizon where there is no ground.
    void: Rgb8,
    /// Colour of level ground at or below 0 m.
    water: Rgb8,
    /// Colour of the wall along the edge of the data.
    wall: Rgb8,
    /// Ground at this many times the distance of the camera's target has lost two thirds of its
    /// colour, 0.1 to 1000.
    haze_reach: f64,
}

/// A style in the units and types of its text, not yet checked: lists and tables of any length.
/// `config/styles/road-atlas.toml` explains every entry.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct StyleFile {
    /// Width of the edge of roads, 0 to 4 pixels.
    outline_px: u32,
    /// Minimum length on the picture of parts of the road network without connections, 0 to 1000
    /// pixels.
    #[serde(default)]
    shortest_part_px: f64,
    #[serde(default)]
    own_width: bool,
    /// Width of a lane, 1 to 10 m.
    lane_width_m: Option<f64>,
    /// Visibility of photos, 0 to 1.
    #[serde(default = "photos_alone")]
    photo: f64,
    width_scaling: WidthScalingSheet,
    light: LightSheet,
    background: BackgroundSheet,
    #[serde(default)]
    tint_by_climate: bool,
    tint: Vec<TintSheet>,
    #[serde(default)]
    layer_defaults: BTreeMap<String, LookSheet>,
    #[serde(default)]
    layers: BTreeMap<String, ClassSheets>,
    roads: BTreeMap<String, RoadSheet>,
}

/// Visibility of photos in a style that does not set it: they hide the height tint.
fn photos_alone() -> f64 {
    1.0
}

/// The preset `road-atlas`.
static ROAD_ATLAS: LazyLock<Style> = LazyLock::new(|| {
    parse_style(style_preset(USUAL).unwrap_or_default())
        .unwrap_or_else(|error| unreachable!("the style that comes along is right: {error}"))
});

impl Style {
    /// The default style, like a road atlas: warm roads with dark edges, pale ground. It is the
    /// preset `road-atlas`.
    #[must_use]
    pub fn road_atlas() -> Self {
        ROAD_ATLAS.clone()
    }
}

/// Parses a style's text. If the text names a built-in style as its `base`, that style supplies the
/// entries that the text omits.
///
/// # Errors
/// When the text is not valid TOML, lacks an entry or has an unknown one (the message names the
/// line); when a number is out of range, a class or the base does not exist, or the tint does not
/// ascend from 0 to 1 (the message names the entry).
pub fn parse_style(text: &str) -> Result<Style, StyleError> {
    if text.len() > MAX_TEXT_BYTES {
        return Err(StyleError::TooLong { bytes: text.len(), limit: MAX_TEXT_BYTES });
    }
    let file = StyleFile::deserialize(toml::Deserializer::from(base::table(text)?));
    let file = file.map_err(|mut error: toml::de::Error| {
        error.set_input(Some(text));
        error
    })?;
    if file.lane_width_m.is_some() && !file.own_width {
        return Err(StyleError::LaneWidth);
    }
    let tint = tint(&file.tint, file.tint_by_climate)?;
    let roads = all_classes(&file.roads)?;
    let layers = layer_looks(&file.layer_defaults, &file.layers)?;
    file.check()?;
    let StyleFile { width_scaling, background, .. } = file;
    Ok(Style {
        roads,
        layers,
        overlays: LineStyle::OVERLAYS,
        drawn: LineStyle::DRAWN,
        own_widths: file
            .own_width
            .then_some(OwnWidths { lane_m: file.lane_width_m.map(|lane_m| lane_m as f32) }),
        width_scaling: WidthScaling {
            threshold_m: width_scaling.threshold_m as f32,
            exponent: width_scaling.exponent as f32,
            constant: width_scaling.constant as f32,
        },
        outline_px: file.outline_px,
        shortest_part_px: file.shortest_part_px as f32,
        tint,
        light: file.light.into(),
        photo: file.photo as f32,
        haze: background.haze.into(),
        sky: background.sky.into(),
        void: background.void.into(),
        water: background.water.into(),
        wall: background.wall.into(),
        haze_reach: background.haze_reach as f32,
    })
}

/// Returns the roads by class, if the classes are complete, no others exist, and each is valid.
fn all_classes(
    roads: &BTreeMap<String, RoadSheet>,
) -> Result<[RoadStyle; FunctionalRoadClass::COUNT], StyleError> {
    let names: [String; FunctionalRoadClass::COUNT] =
        std::array::from_fn(|class| class.to_string());
    if let Some(text) = roads.keys().find(|text| !names.contains(text)) {
        return Err(StyleError::Class { text: text.clone() });
    }
    let road = |number: usize| {
        let class = &names[number];
        let missing = || StyleError::MissingClass { class: class.clone() };
        roads.get(class).ok_or_else(missing)?.checked(number)
    };
    let mut styles = [road(0)?; FunctionalRoadClass::COUNT];
    for (number, style) in styles.iter_mut().enumerate().skip(1) {
        *style = road(number)?;
    }
    Ok(styles)
}

impl StyleFile {
    /// Checks every number against its range.
    fn check(&self) -> Result<(), StyleError> {
        let Self { outline_px, lane_width_m, width_scaling: scaling, .. } = self;
        let Self { light, background, .. } = self;
        // The kernel reads (2 r + 1)² samples for every pixel.
        within("outline_px", f64::from(*outline_px), 0.0..=4.0)?;
        within("shortest_part_px", self.shortest_part_px, 0.0..=1000.0)?;
        if let Some(lane_width_m) = lane_width_m {
            within("lane_width_m", *lane_width_m, 1.0..=f64::from(OwnWidths::WIDEST_LANE_M))?;
        }
        within("photo", self.photo, 0.0..=1.0)?;
        within("width_scaling.threshold_m", scaling.threshold_m, 1.0..=1e7)?;
        within("width_scaling.exponent", scaling.exponent, 0.0..=1.0)?;
        within("width_scaling.constant", scaling.constant, 0.1..=100.0)?;
        light.check()?;
        within("background.haze_reach", background.haze_reach, 0.1..=1000.0)?;
        Ok(())
    }
}

#[cfg(test)]
#[path = "sheet_tests.rs"]
mod tests;
