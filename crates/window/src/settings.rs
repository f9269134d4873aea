//! What can be changed while the window is open, as plain values.

use std::collections::BTreeSet;

use corniche_roads::FunctionalRoadClass;
use corniche_styles::Style;
use corniche_viewer::{RoadMethod, RoadOptions, Wireframe};

use crate::Visibility;

/// Whether one method is shown, or two are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Compare {
    /// One method.
    Off,
    /// GEO to the left of a divider, SV to the right.
    Split,
    /// Where GEO and SV show different classes.
    Difference,
}

impl Compare {
    /// The options of the roads for each picture: one picture, or GEO and SV.
    pub(crate) fn pictures(self, roads: RoadOptions) -> Vec<RoadOptions> {
        match self {
            Self::Off => vec![roads],
            Self::Split | Self::Difference => [RoadMethod::Geometry, RoadMethod::ShadowVolumes]
                .map(|method| RoadOptions { method, ..roads })
                .into(),
        }
    }
}

/// Whether the choice of tiles follows the camera.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Refinement {
    /// It follows the camera.
    Live,
    /// The tiles that are drawn now stay, wherever the camera goes, so that the choice can be looked at from elsewhere.
    Frozen,
}

/// Everything that the panel changes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Settings {
    /// How roads are drawn.
    pub(crate) roads: RoadOptions,
    /// Whether one method is shown, or two are compared.
    pub(crate) compare: Compare,
    /// Position of the divider, as a share of the window's width.
    pub(crate) divider_share: f32,
    /// Factors on the style's widths, class 0 first.
    pub(crate) width_factors: [f32; FunctionalRoadClass::COUNT],
    /// Place of the style in the list of styles.
    pub(crate) style: usize,
    /// How strongly photos are seen, 0 to 1; `None`: as the style says.
    pub(crate) photo: Option<f32>,
    /// Whether areas are drawn as the style says, or not at all.
    pub(crate) areas: Visibility,
    /// Whether boundaries are drawn as the style says, or not at all.
    pub(crate) boundaries: Visibility,
    /// Files of lines that are not shown, by their numbers.
    pub(crate) hidden_overlays: BTreeSet<usize>,
    /// Factor on heights; 1 is true.
    pub(crate) exaggeration: f64,
    /// A tile is refined while its error looks larger than this.
    pub(crate) screen_space_error_px: f64,
    /// A tile is refined while one of its cells looks larger than this.
    pub(crate) cell_px: f64,
    /// Samples per pixel along each side.
    pub(crate) samples_per_side: u32,
    /// Whether the edges of triangles are drawn.
    pub(crate) is_wireframe: bool,
    /// Whether the choice of tiles follows the camera.
    pub(crate) refinement: Refinement,
    /// Whether the panel is open.
    pub(crate) is_panel_open: bool,
    /// Whether the page of keys and mouse is open.
    pub(crate) is_help_open: bool,
    /// What is typed as the place to go to.
    pub(crate) place: String,
}

/// Ranges of the settings.
pub(crate) mod range {
    use std::ops::RangeInclusive;

    pub(crate) const EXAGGERATION: RangeInclusive<f64> = 0.25..=8.0;
    pub(crate) const SCREEN_SPACE_ERROR_PX: RangeInclusive<f64> = 0.5..=8.0;
    pub(crate) const SAMPLES_PER_SIDE: RangeInclusive<u32> =
        1..=corniche_viewer::gpu::MAX_SAMPLES_PER_SIDE;
    pub(crate) const WIDTH_FACTOR: RangeInclusive<f32> = 0.25..=4.0;
    pub(crate) const PHOTO: RangeInclusive<f32> = 0.0..=1.0;
    pub(crate) const DIVIDER_SHARE: RangeInclusive<f32> = 0.05..=0.95;
}

impl Settings {
    /// A style with its widths multiplied by their factors, photos as strong as is wanted, and without areas and lines of files that are not.
    pub(crate) fn applied_to(&self, style: &Style) -> Style {
        let mut applied = match self.areas {
            Visibility::Shown => style.clone(),
            Visibility::Hidden => style.clone().without_areas(),
        };
        applied.photo = self.photo.unwrap_or(applied.photo);
        if self.boundaries == Visibility::Hidden {
            applied = applied.without_boundaries();
        }
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

    /// Whether the edges of triangles are drawn, in the viewer's words.
    pub(crate) fn wireframe(&self) -> Wireframe {
        if self.is_wireframe { Wireframe::Shown } else { Wireframe::Hidden }
    }
}

#[cfg(test)]
pub(crate) fn usual() -> Settings {
    Settings {
        roads: RoadOptions::of(RoadMethod::ShadowVolumes),
        compare: Compare::Off,
        divider_share: 0.5,
        width_factors: [1.0; FunctionalRoadClass::COUNT],
        style: 0,
        photo: None,
        areas: Visibility::Shown,
        boundaries: Visibility::Shown,
        hidden_overlays: BTreeSet::new(),
        exaggeration: 1.0,
        screen_space_error_px: 2.0,
        cell_px: f64::INFINITY,
        samples_per_side: 2,
        is_wireframe: false,
        refinement: Refinement::Live,
        is_panel_open: true,
        is_help_open: false,
        place: String::new(),
    }
}

#[cfg(test)]
#[path = "settings_tests.rs"]
mod tests;
