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

    /// Lines of files, in the order of the files: colours that can be told from each other and from
    /// roads, with a pale edge so that they are seen on any ground.
    pub(crate) const OVERLAYS: [Self; Self::MOST] = [
        Self::with_edge([0xC2, 0x1E, 0x8A], [0xFF; 3]),
        Self::with_edge([0x1F, 0x5F, 0xD0], [0xFF; 3]),
        Self::with_edge([0x0B, 0x8A, 0x7A], [0xFF; 3]),
        Self::with_edge([0x7A, 0x34, 0xB8], [0xFF; 3]),
        Self::with_edge([0xD0, 0x1F, 0x2E], [0xFF; 3]),
        Self::with_edge([0x2C, 0x7A, 0x1E], [0xFF; 3]),
        Self::with_edge([0x00, 0x8F, 0xC4], [0xFF; 3]),
        Self::with_edge([0x8A, 0x4B, 0x12], [0xFF; 3]),
        Self::with_edge([0x2B; 3], [0xFF; 3]),
    ];

    /// Lines that a person draws.
    pub(crate) const DRAWN: Self = Self::with_edge([0xFF, 0xE6, 0x00], [0x2B; 3]);

    /// What is not drawn.
    pub(crate) const NOTHING: Self = Self { opacity: 0.0, ..Self::solid([0.0; 3], 1.0) };

    const fn with_edge(color: [u8; 3], edge: [u8; 3]) -> Self {
        Self { casing: Some(shares(edge)), ..Self::solid(shares(color), 3.0) }
    }

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

/// A colour in bytes as shares.
const fn shares([red, green, blue]: [u8; 3]) -> Rgb {
    [red as f32 / 255.0, green as f32 / 255.0, blue as f32 / 255.0]
}
