//! How roads fade out where the picture becomes too coarse for their class.

use corniche_roads::FunctionalRoadClass;

use crate::{RoadStyle, Style};

/// How much coarser than a class's last full scale the picture is where the class has faded away: half a zoom step.
pub const FADE_FACTOR: f64 = std::f64::consts::SQRT_2;

impl RoadStyle {
    /// The metres of ground in a pixel from which on the road is not drawn at all; infinite for one that always is.
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
