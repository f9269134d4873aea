//! Styles of lines that are not roads: lines of layers, and lines from users' files.

use corniche_roads::FunctionalRoadClass;
use serde::{Deserialize, Serialize};

use crate::{Dash, Rgb};

/// How lines of one kind are drawn: with a constant width on the picture, over the roads.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LineStyle {
    /// Colour of the line.
    pub color: Rgb,
    /// Width on the picture, pixels.
    pub width_px: f32,
    /// Colour of an edge of one pixel on both sides, outside of the width; `None`: no edge.
    pub casing: Option<Rgb>,
    /// How much of the map a line hides; 0 does not draw the line.
    pub opacity: f32,
    /// The dash pattern of the line.
    pub dash: Dash,
    /// The most true metres of ground per pixel at which the line is fully drawn, as in
    /// [`RoadStyle::max_pixel_m`](crate::RoadStyle::max_pixel_m).
    pub max_pixel_m: Option<f32>,
    /// Whether lines are omitted on roads and close to them: a line that follows a road would look
    /// like the dashes of a tunnel.
    pub is_apart_from_roads: bool,
}

impl LineStyle {
    /// How many styles lines that are drawn at once can have.
    pub const MOST: usize = FunctionalRoadClass::COUNT;

    /// Styles for lines of users' files, in the order of the files. The colours differ from each
    /// other and from roads; a pale edge makes the lines visible on any ground.
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

    /// The style of lines that a user draws.
    pub(crate) const DRAWN: Self = Self::with_edge([0xFF, 0xE6, 0x00], [0x2B; 3]);

    /// A style that draws nothing.
    pub const NOTHING: Self = Self { opacity: 0.0, ..Self::solid([0.0; 3], 1.0) };

    const fn with_edge(color: [u8; 3], edge: [u8; 3]) -> Self {
        Self { casing: Some(shares(edge)), ..Self::solid(shares(color), 3.0) }
    }

    /// A solid line of this colour and width, drawn everywhere.
    #[must_use]
    pub const fn solid(color: Rgb, width_px: f32) -> Self {
        Self {
            color,
            width_px,
            casing: None,
            opacity: 1.0,
            dash: Dash::SOLID,
            max_pixel_m: None,
            is_apart_from_roads: false,
        }
    }
}

/// Converts a colour in bytes to shares.
const fn shares([red, green, blue]: [u8; 3]) -> Rgb {
    [red as f32 / 255.0, green as f32 / 255.0, blue as f32 / 255.0]
}
