//! How roads fade out where the picture becomes too coarse for their class.

use corniche_roads::FunctionalRoadClass;

use crate::{RoadStyle, Style};

/// Half a zoom step: a class has faded out when pixels are this many times coarser than its last
/// full scale.
pub const FADE_FACTOR: f64 = std::f64::consts::SQRT_2;

impl RoadStyle {
    /// The metres of ground per pixel from which on the road is not drawn at all; infinite for a
    /// road that is always drawn.
    #[must_use]
    pub fn last_pixel_m(&self) -> f64 {
        self.max_pixel_m.map_or(f64::INFINITY, |max_pixel_m| f64::from(max_pixel_m) * FADE_FACTOR)
    }
}

impl Style {
    /// The roads of a class.
    #[must_use]
    pub fn road(&self, class: FunctionalRoadClass) -> &RoadStyle {
        &self.roads[usize::from(class.number())]
    }
}

#[cfg(test)]
#[path = "road_scale_tests.rs"]
mod tests;
