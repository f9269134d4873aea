use std::{collections::BTreeMap, ops::RangeInclusive};

use corniche_roads::FunctionalRoadClass;
use serde::Deserialize;

use crate::{PresetError, error::bounded};

/// Styles that come with the program.
const PRESETS: [(&str, &str); 2] = [
    ("road-atlas", include_str!("../../../config/styles/road-atlas.toml")),
    ("dark", include_str!("../../../config/styles/dark.toml")),
];

/// How many colours the tint has.
pub const TINT_COLORS: usize = 6;

/// From one share of the tint to the next. What draws divides by it, in f32.
const LEAST_STEP: f64 = 0.001;

/// A colour as red, green, blue in sRGB.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub struct Rgb8(pub [u8; 3]);

/// How a map looks, as it is written down. `config/styles/road-atlas.toml` tells what each entry means.
#[derive(Debug, Clone, PartialEq)]
pub struct StyleSheet {
    /// Width of the edge of roads, 0 to 4 pixels.
    pub outline_px: u32,
    /// Growth with distance.
    pub width_scaling: WidthScalingSheet,
    /// Light and shade.
    pub light: LightSheet,
    /// Sky, haze and void.
    pub background: BackgroundSheet,
    /// Height tint, lowest first; shares ascend from 0 to 1.
    pub tint: [TintSheet; TINT_COLORS],
    /// By class, 0 first.
    pub roads: [RoadSheet; FunctionalRoadClass::COUNT],
}

/// How far roads grow with distance.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WidthScalingSheet {
    /// Distance from the eye up to which widths are true, 1 to 1e7 m.
    pub threshold_m: f64,
    /// 0 to 1.
    pub exponent: f64,
    /// Factor on all widths when they grow by a constant, 0.1 to 100.
    pub constant: f64,
}

/// Where the light comes from.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LightSheet {
    /// Clockwise from north, 0 to 360.
    pub azimuth_deg: f64,
    /// Above the horizon, 0 to 90.
    pub altitude_deg: f64,
    /// How strongly slopes are shaded, 0 to 1.
    pub hillshade: f64,
}

/// What is seen where no near ground is.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BackgroundSheet {
    /// Far ground and the sky at the horizon.
    pub haze: Rgb8,
    /// The sky far above the horizon.
    pub sky: Rgb8,
    /// Where there is no ground, below the horizon.
    pub void: Rgb8,
    /// Ground so many times as far as what is looked at has lost two thirds of its colour; 0.1 to 1000.
    pub haze_reach: f64,
}

/// One colour of the tint.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TintSheet {
    /// Where in the height range, 0 to 1.
    pub share: f64,
    /// The colour there.
    pub color: Rgb8,
}

/// How the roads of one class are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RoadSheet {
    /// Width on the ground, 0.1 to 500 m.
    pub width_m: f64,
    /// Never drawn thinner than this, 0.1 to 50 pixels.
    pub min_width_px: f64,
    /// Fill.
    pub color: Rgb8,
    /// Edge.
    pub outline: Rgb8,
    /// A line along the middle.
    pub center: Option<CenterSheet>,
}

/// The line along the middle of a road of two colours.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CenterSheet {
    /// Share of the road's width, 0.01 to 0.99.
    pub width_share: f64,
    /// Its colour.
    pub color: Rgb8,
}

/// A style as it stands in the file: lists and tables of any length.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct StyleFile {
    outline_px: u32,
    width_scaling: WidthScalingSheet,
    light: LightSheet,
    background: BackgroundSheet,
    tint: Vec<TintSheet>,
    roads: BTreeMap<String, RoadSheet>,
}

/// Names of the styles that come with the program, the default one first.
pub fn style_preset_names() -> impl Iterator<Item = &'static str> {
    PRESETS.iter().map(|(name, _)| *name)
}

/// The text of the style of this name that comes with the program, for [`parse_style`].
#[must_use]
pub fn style_preset(name: &str) -> Option<&'static str> {
    PRESETS.iter().find(|(preset, _)| *preset == name).map(|(_, text)| *text)
}

/// Reads a style's text.
///
/// # Errors
/// When it is no TOML, leaves something out or says something unknown (the message names the line); when a number is
/// out of its range, a class is missing, or the tint does not ascend from 0 to 1 (the message names the entry).
pub fn parse_style(text: &str) -> Result<StyleSheet, PresetError> {
    let file: StyleFile = toml::from_str(bounded(text)?)?;
    let StyleFile { outline_px, width_scaling, light, background, tint, roads } = file;
    let sheet = StyleSheet {
        outline_px,
        width_scaling,
        light,
        background,
        tint: ascending(tint)?,
        roads: all_classes(&roads)?,
    };
    sheet.check()?;
    Ok(sheet)
}

/// The tint, if it has as many colours as are needed, lowest first, from 0 to 1.
#[expect(clippy::float_cmp, reason = "the ends of the tint are given exactly or not at all")]
fn ascending(tint: Vec<TintSheet>) -> Result<[TintSheet; TINT_COLORS], PresetError> {
    let count = tint.len();
    let tint: [TintSheet; TINT_COLORS] =
        tint.try_into().map_err(|_| PresetError::TintCount { count, needed: TINT_COLORS })?;
    let ends = [tint[0].share, tint[TINT_COLORS - 1].share];
    if ends != [0.0, 1.0] || !tint.is_sorted_by(|a, b| a.share + LEAST_STEP <= b.share) {
        return Err(PresetError::TintOrder);
    }
    Ok(tint)
}

/// The roads by class, if there are all of them and no others.
fn all_classes(
    roads: &BTreeMap<String, RoadSheet>,
) -> Result<[RoadSheet; FunctionalRoadClass::COUNT], PresetError> {
    let names: [String; FunctionalRoadClass::COUNT] =
        std::array::from_fn(|class| class.to_string());
    if let Some(text) = roads.keys().find(|text| !names.contains(text)) {
        return Err(PresetError::StyleClass { text: text.clone() });
    }
    // Keys of one digit each: in the order of their names they are in the order of their numbers.
    let known: Vec<RoadSheet> = roads.values().copied().collect();
    known.try_into().map_err(|_| {
        let missing = names.into_iter().find(|name| !roads.contains_key(name)).unwrap_or_default();
        PresetError::MissingClass { class: missing }
    })
}

impl StyleSheet {
    /// Checks every number against its range.
    fn check(&self) -> Result<(), PresetError> {
        let Self { outline_px, width_scaling: scaling, light, background, roads, .. } = self;
        // The kernel looks at (2 r + 1)² places for every pixel.
        within("outline_px", f64::from(*outline_px), 0.0..=4.0)?;
        within("width_scaling.threshold_m", scaling.threshold_m, 1.0..=1e7)?;
        within("width_scaling.exponent", scaling.exponent, 0.0..=1.0)?;
        within("width_scaling.constant", scaling.constant, 0.1..=100.0)?;
        within("light.azimuth_deg", light.azimuth_deg, 0.0..=360.0)?;
        within("light.altitude_deg", light.altitude_deg, 0.0..=90.0)?;
        within("light.hillshade", light.hillshade, 0.0..=1.0)?;
        within("background.haze_reach", background.haze_reach, 0.1..=1000.0)?;
        for (class, road) in roads.iter().enumerate() {
            let entry = |name| format!("roads.{class}.{name}");
            within(&entry("width_m"), road.width_m, 0.1..=500.0)?;
            within(&entry("min_width_px"), road.min_width_px, 0.1..=50.0)?;
            if let Some(center) = road.center {
                within(&entry("center.width_share"), center.width_share, 0.01..=0.99)?;
            }
        }
        Ok(())
    }
}

fn within(entry: &str, value: f64, range: RangeInclusive<f64>) -> Result<(), PresetError> {
    // What is not a number is in no range.
    if range.contains(&value) {
        return Ok(());
    }
    Err(PresetError::StyleRange {
        entry: entry.to_owned(),
        value,
        least: *range.start(),
        most: *range.end(),
    })
}

impl TryFrom<String> for Rgb8 {
    type Error = String;

    /// Reads "#RRGGBB".
    fn try_from(text: String) -> Result<Self, String> {
        let digits = text
            .strip_prefix('#')
            // `from_str_radix` would take a sign too.
            .filter(|digits| digits.len() == 6 && digits.bytes().all(|b| b.is_ascii_hexdigit()))
            .and_then(|digits| u32::from_str_radix(digits, 16).ok());
        let [_, red, green, blue] = digits
            .ok_or_else(|| format!("{text:?} is no colour; write it like \"#D93A2B\""))?
            .to_be_bytes();
        Ok(Self([red, green, blue]))
    }
}

#[cfg(test)]
#[path = "style_tests.rs"]
mod tests;
