//! How lines beside the roads are drawn: boundaries, and lines of people's own files.

use corniche_roads::FunctionalRoadClass;
use serde::{Deserialize, Serialize};

use crate::{Dash, Rgb};

/// How lines of one kind are drawn: everywhere equally wide on the picture, over the roads.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LineStyle {
    /// Its colour.
    pub color: Rgb,
    /// Width on the picture.
    pub width_px: f32,
    /// Colour of an edge of one pixel on both sides, outside of the width; `None`: without.
    pub casing: Option<Rgb>,
    /// How much of the map a line hides; 0 does not draw it.
    pub opacity: f32,
    /// Dashes along it.
    pub dash: Dash,
    /// The most true metres of ground in a pixel at which it is drawn in full, as [`RoadStyle::max_pixel_m`](crate::RoadStyle::max_pixel_m).
    pub max_pixel_m: Option<f32>,
}

impl LineStyle {
    /// How many styles the lines of one layer can have.
    pub const MOST: usize = FunctionalRoadClass::COUNT;

    /// A solid line of this colour and width, drawn everywhere.
    #[must_use]
    pub const fn solid(color: Rgb, width_px: f32) -> Self {
        let (opacity, dash) = (1.0, Dash::SOLID);
        Self { color, width_px, casing: None, opacity, dash, max_pixel_m: None }
    }

    /// Whether such lines are drawn at all.
    #[must_use]
    pub fn is_drawn(&self) -> bool {
        self.opacity > 0.0
    }
}
