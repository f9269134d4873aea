//! How roads fade out where the picture becomes too coarse for their class.

use corniche_roads::FunctionalRoadClass;

use crate::{RoadStyle, Style};

/// How much coarser than a class's last full scale the picture is where the class has faded away: half a zoom step.
pub const FADE_FACTOR: f64 = std::f64::consts::SQRT_2;

impl RoadStyle {
    /// Share of the road's colour that is drawn where a pixel shows `pixel_m` true metres of the ground: 1 up to
    /// [`RoadStyle::max_pixel_m`], 0 from [`FADE_FACTOR`] times that on, and between them linear in the zoom, that is in the
    /// logarithm of `pixel_m`.
    #[must_use]
    pub fn shown_share(&self, pixel_m: f64) -> f64 {
        let Some(max_pixel_m) = self.max_pixel_m else { return 1.0 };
        let steps = libm::log(pixel_m / f64::from(max_pixel_m)) / libm::log(FADE_FACTOR);
        (1.0 - steps).clamp(0.0, 1.0)
    }

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

    /// The same style with every class drawn at every scale.
    #[must_use]
    pub fn at_every_scale(mut self) -> Self {
        for road in &mut self.roads {
            road.max_pixel_m = None;
        }
        self
    }
}

#[cfg(test)]
#[path = "road_scale_tests.rs"]
mod tests;
