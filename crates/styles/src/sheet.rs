//! The text of a style: TOML, checked entry by entry, and then turned into the values that are drawn with.

use std::{collections::BTreeMap, sync::LazyLock};

use corniche_areas::AreaClass;
use corniche_roads::FunctionalRoadClass;
use serde::Deserialize;

use crate::{
    AreaStyle, LineStyle, OwnWidths, RoadStyle, Style, StyleError, Tint, WidthScaling,
    area_sheet::{AreaSheet, areas},
    base::{self, USUAL},
    ground_sheet::{LightSheet, TintSheet, tint},
    line_sheet::{LineSheet, boundaries},
    road_sheet::RoadSheet,
    sheet_values::{Rgb8, within},
    style_preset,
};

/// Longest text that is read. The longest preset has some 3 kB.
const MAX_TEXT_BYTES: usize = 1 << 20;

/// A style in the units and types of its text, checked. `config/styles/road-atlas.toml` tells what each entry means.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct StyleSheet {
    /// Width of the edge of roads, 0 to 4 pixels.
    pub(crate) outline_px: u32,
    /// Roads that stand alone are drawn where they are at least so long, 0 to 1000 pixels.
    pub(crate) shortest_part_px: f64,
    /// Whether roads are drawn by their own `width` where it is tagged.
    pub(crate) own_width: bool,
    /// Width of a lane, 1 to 10 m, for roads with `lanes` and without `width`.
    pub(crate) lane_width_m: Option<f64>,
    /// How strongly photos are seen, 0 to 1.
    pub(crate) photo: f64,
    /// How roads widen with distance.
    pub(crate) width_scaling: WidthScalingSheet,
    /// Light and shade.
    pub(crate) light: LightSheet,
    /// Sky, haze, void, water, and the wall along the edge of the data.
    pub(crate) background: BackgroundSheet,
    /// Height tint.
    pub(crate) tint: Tint,
    /// The roads of each class, 0 first.
    pub(crate) roads: [RoadStyle; FunctionalRoadClass::COUNT],
    /// The areas of each class, in order of their numbers.
    pub(crate) areas: [AreaStyle; AreaClass::COUNT],
    /// The boundaries of each class, in order of their numbers.
    pub(crate) boundaries: [LineStyle; LineStyle::MOST],
    /// The lines of files, in the order of the files.
    pub(crate) overlays: [LineStyle; LineStyle::MOST],
    /// Lines that a person draws.
    pub(crate) drawn: LineStyle,
}

/// How roads widen with distance.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct WidthScalingSheet {
    /// Distance from the eye up to which widths are true, 1 to 1e7 m.
    pub(crate) threshold_m: f64,
    /// 0 to 1.
    pub(crate) exponent: f64,
    /// Factor on all widths where they are multiplied by a constant, 0.1 to 100.
    pub(crate) constant: f64,
}

/// Colours where there is no near ground.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct BackgroundSheet {
    /// Far ground and the sky at the horizon.
    pub(crate) haze: Rgb8,
    /// The sky far above the horizon.
    pub(crate) sky: Rgb8,
    /// Where there is no ground, below the horizon.
    pub(crate) void: Rgb8,
    /// Level ground at or below 0 m.
    pub(crate) water: Rgb8,
    /// The wall along the edge of the data.
    pub(crate) wall: Rgb8,
    /// Ground at this many times the distance of what is looked at has lost two thirds of its colour; 0.1 to 1000.
    pub(crate) haze_reach: f64,
}

/// A style as it stands in the text, not yet checked: lists and tables of any length.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct StyleFile {
    outline_px: u32,
    #[serde(default)]
    shortest_part_px: f64,
    #[serde(default)]
    own_width: bool,
    lane_width_m: Option<f64>,
    #[serde(default = "photos_alone")]
    photo: f64,
    width_scaling: WidthScalingSheet,
    light: LightSheet,
    background: BackgroundSheet,
    #[serde(default)]
    tint_by_climate: bool,
    tint: Vec<TintSheet>,
    #[serde(default)]
    areas: BTreeMap<String, AreaSheet>,
    #[serde(default)]
    boundaries: BTreeMap<String, LineSheet>,
    roads: BTreeMap<String, RoadSheet>,
}

/// Photos hide the height tint, where a style does not say how strongly they are seen.
fn photos_alone() -> f64 {
    1.0
}

/// The preset `road-atlas`.
static ROAD_ATLAS: LazyLock<Style> = LazyLock::new(|| {
    parse_style(style_preset(USUAL).unwrap_or_default())
        .unwrap_or_else(|error| unreachable!("the style that comes along is right: {error}"))
});

impl Style {
    /// The default style, like a road atlas: warm roads with dark edges, pale ground. It is the preset `road-atlas`.
    #[must_use]
    pub fn road_atlas() -> Self {
        ROAD_ATLAS.clone()
    }
}

/// Reads a style's text. With `base`, the name of a style that comes along, it has the entries of that style where it says nothing.
///
/// # Errors
/// When it is no TOML, leaves something out or says something unknown (the message names the line); when a number is
/// out of its range, a class or the base is missing, or the tint does not ascend from 0 to 1 (the message names the entry).
pub fn parse_style(text: &str) -> Result<Style, StyleError> {
    parse_sheet(text).map(|sheet| Style::from(&sheet))
}

fn parse_sheet(text: &str) -> Result<StyleSheet, StyleError> {
    if text.len() > MAX_TEXT_BYTES {
        return Err(StyleError::TooLong { bytes: text.len(), limit: MAX_TEXT_BYTES });
    }
    let file = StyleFile::deserialize(toml::Deserializer::from(base::table(text)?));
    let file = file.map_err(|mut error: toml::de::Error| {
        error.set_input(Some(text));
        error
    })?;
    let StyleFile {
        outline_px,
        shortest_part_px,
        own_width,
        lane_width_m,
        photo,
        width_scaling,
        light,
        background,
        tint_by_climate,
        tint: stops,
        areas: area_sheets,
        boundaries: line_sheets,
        roads,
    } = file;
    if lane_width_m.is_some() && !own_width {
        return Err(StyleError::LaneWidth);
    }
    let sheet = StyleSheet {
        outline_px,
        shortest_part_px,
        own_width,
        lane_width_m,
        photo,
        width_scaling,
        light,
        background,
        tint: tint(&stops, tint_by_climate)?,
        roads: all_classes(&roads)?,
        areas: areas(&area_sheets)?,
        boundaries: boundaries(&line_sheets)?,
        overlays: LineStyle::OVERLAYS,
        drawn: LineStyle::DRAWN,
    };
    sheet.check()?;
    Ok(sheet)
}

/// The roads by class, if there are all of them and no others, and each is right.
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

impl StyleSheet {
    /// Checks every number against its range.
    fn check(&self) -> Result<(), StyleError> {
        let Self { outline_px, lane_width_m, width_scaling: scaling, .. } = self;
        let Self { light, background, .. } = self;
        // The kernel looks at (2 r + 1)² places for every pixel.
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

impl From<&StyleSheet> for Style {
    fn from(sheet: &StyleSheet) -> Self {
        let StyleSheet { outline_px, own_width, lane_width_m, width_scaling, .. } = sheet;
        let StyleSheet { light, background, tint, roads, .. } = sheet;
        let lane_m = lane_width_m.map(|lane_m| lane_m as f32);
        Self {
            roads: *roads,
            areas: sheet.areas,
            boundaries: sheet.boundaries,
            overlays: sheet.overlays,
            drawn: sheet.drawn,
            own_widths: own_width.then_some(OwnWidths { lane_m }),
            width_scaling: WidthScaling {
                threshold_m: width_scaling.threshold_m as f32,
                exponent: width_scaling.exponent as f32,
                constant: width_scaling.constant as f32,
            },
            outline_px: *outline_px,
            shortest_part_px: sheet.shortest_part_px as f32,
            tint: tint.clone(),
            light: (*light).into(),
            photo: sheet.photo as f32,
            haze: background.haze.into(),
            sky: background.sky.into(),
            void: background.void.into(),
            water: background.water.into(),
            wall: background.wall.into(),
            haze_reach: background.haze_reach as f32,
        }
    }
}

#[cfg(test)]
#[path = "sheet_tests.rs"]
mod tests;
