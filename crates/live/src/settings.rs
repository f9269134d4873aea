//! The settings of a map that the user can change, as plain values.

use std::collections::BTreeSet;

use corniche_roads::FunctionalRoadClass;
use corniche_styles::Style;
use corniche_tileset::Manifest;
use corniche_viewer::{
    PackageLooks, RoadMethod, RoadOptions, ShownLayers,
    lod::{Fineness, Quality},
    tiles::TileDecoder,
};
use serde::{Deserialize, Serialize};

/// Whether one method is shown, or two are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Compare {
    /// One method.
    Off,
    /// GEO to the left of a divider, SV to the right.
    Split,
    /// Where GEO and SV show different classes.
    Difference,
}

impl Compare {
    /// The road options of each image: one image, or GEO and SV.
    #[must_use]
    pub fn pictures(self, roads: RoadOptions) -> Vec<RoadOptions> {
        match self {
            Self::Off => vec![roads],
            Self::Split | Self::Difference => [RoadMethod::Geometry, RoadMethod::ShadowVolumes]
                .map(|method| RoadOptions { method, ..roads })
                .into(),
        }
    }
}

/// All settings of a map, and of its panel.
#[derive(Debug, Clone, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "independent checkboxes")]
pub struct MapSettings {
    /// The drawing method of roads.
    pub roads: RoadOptions,
    /// Whether one method is shown, or two are compared.
    pub compare: Compare,
    /// The position of the divider, as a share of the map's width.
    pub divider_share: f32,
    /// Factors on the style's widths, class 0 first.
    pub width_factors: [f32; FunctionalRoadClass::COUNT],
    /// The index of the style in the list of styles.
    pub style: usize,
    /// The opacity of photos, 0 to 1; `None` for that of the style.
    pub photo: Option<f32>,
    /// The layers that are drawn.
    pub layers: ShownLayers,
    /// The numbers of the line files that are hidden.
    pub hidden_overlays: BTreeSet<usize>,
    /// Factor on heights; 1 is true.
    pub exaggeration: f64,
    /// A tile is refined while its error looks larger than this.
    pub screen_space_error_px: f64,
    /// A tile is refined while one of its cells looks larger than this.
    pub cell_px: f64,
    /// Samples per pixel along each side.
    pub samples_per_side: u32,
    /// Whether the edges of triangles are drawn.
    pub is_wireframe: bool,
    /// Whether the drawn tiles stay the same while the camera moves, so that their selection can be
    /// inspected from elsewhere.
    pub is_frozen: bool,
    /// Whether the panel is open.
    pub is_panel_open: bool,
    /// Whether the page of keys and mouse is open.
    pub is_help_open: bool,
    /// The text typed as the place to go to.
    pub place: String,
}

/// Ranges of the settings in a panel.
pub mod range {
    use std::ops::RangeInclusive;

    /// Factors on heights.
    pub const EXAGGERATION: RangeInclusive<f64> = 0.25..=8.0;
    /// Errors of the ground on the screen, pixels.
    pub const SCREEN_SPACE_ERROR_PX: RangeInclusive<f64> = 0.5..=8.0;
    /// Samples per pixel along each side.
    pub const SAMPLES_PER_SIDE: RangeInclusive<u32> =
        1..=corniche_viewer::gpu::MAX_SAMPLES_PER_SIDE;
    /// Factors on the widths of classes.
    pub const WIDTH_FACTOR: RangeInclusive<f32> = 0.25..=4.0;
    /// Opacities of photos.
    pub const PHOTO: RangeInclusive<f32> = 0.0..=1.0;
    /// Positions of the divider, as shares of the map's width.
    pub const DIVIDER_SHARE: RangeInclusive<f32> = 0.05..=0.95;
}

impl MapSettings {
    /// The default settings: roads like these, everything of the first style, true heights.
    #[must_use]
    pub fn usual(roads: RoadOptions) -> Self {
        Self {
            roads,
            compare: Compare::Off,
            divider_share: 0.5,
            width_factors: [1.0; FunctionalRoadClass::COUNT],
            style: 0,
            photo: None,
            layers: ShownLayers::ALL,
            hidden_overlays: BTreeSet::new(),
            exaggeration: 1.0,
            screen_space_error_px: 2.0,
            cell_px: f64::INFINITY,
            samples_per_side: 2,
            is_wireframe: false,
            is_frozen: false,
            is_panel_open: true,
            is_help_open: false,
            place: String::new(),
        }
    }

    /// The style with its widths multiplied by their factors, with the chosen opacity of photos,
    /// and without hidden lines of files.
    #[must_use]
    pub fn applied_to(&self, style: &Style) -> Style {
        let mut applied = style.clone();
        applied.photo = self.photo.unwrap_or(applied.photo);
        for (number, line) in applied.overlays.iter_mut().enumerate() {
            if self.hidden_overlays.contains(&number) {
                line.opacity = 0.0;
            }
        }
        for (road, factor) in applied.roads.iter_mut().zip(self.width_factors) {
            *road = road.widened(factor);
        }
        applied
    }

    /// The quality at which the ground of a package is drawn in this style.
    #[must_use]
    pub fn quality(&self, manifest: &Manifest, style: &Style) -> Quality {
        let Self { screen_space_error_px, cell_px, .. } = *self;
        let fineness = Fineness { screen_space_error_px, cell_px };
        Quality::of_package(manifest, fineness, style, self.roads, self.exaggeration)
    }

    /// How the layers of a package are drawn in this style.
    #[must_use]
    pub fn looks(&self, manifest: &Manifest, style: &Style) -> PackageLooks {
        PackageLooks::new(manifest, style, &self.layers)
    }

    /// The decoder of the tile sections of a package that this style needs.
    #[must_use]
    pub fn decoder(&self, manifest: &Manifest, style: &Style) -> TileDecoder {
        let (look, layers) = (self.applied_to(style), self.looks(manifest, style));
        let decoder = TileDecoder::default();
        match self.compare {
            Compare::Off => decoder.for_look(self.roads.method, &look, layers.drawn_layers()),
            Compare::Split | Compare::Difference => {
                decoder.with_layers_of(&look, layers.drawn_layers())
            }
        }
    }
}

#[cfg(test)]
#[path = "settings_tests.rs"]
mod tests;
