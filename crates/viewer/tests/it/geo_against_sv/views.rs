//! Views of a package, drawn from a seed.

use std::fmt;

use corniche_testing::Random;
use corniche_viewer::camera::Orientation;

/// A place on a road in plan, with its longitude and latitude.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RoadPlace {
    pub(crate) at_m: [f64; 2],
    pub(crate) lon_lat_deg: [f64; 2],
}

/// A view of a package.
#[derive(Debug, Clone, Copy)]
pub(crate) struct View {
    pub(crate) place: RoadPlace,
    pub(crate) distance_m: f64,
    pub(crate) orientation: Orientation,
}

impl fmt::Display for View {
    /// Formats the view as options of `corniche render`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([lon_deg, lat_deg], Orientation { heading_deg, pitch_deg }) =
            (self.place.lon_lat_deg, self.orientation);
        let distance_m = self.distance_m;
        write!(
            f,
            "--look-at {lon_deg:.6},{lat_deg:.6} --distance {distance_m:.1} --heading {heading_deg:.2} --pitch {pitch_deg:.2}"
        )
    }
}

/// The agreement of two drawings of a view.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct PixelAgreement {
    /// Pixels of roads in SV.
    pub(crate) of_roads: usize,
    /// Pixels whose labels differ, outside the band.
    pub(crate) differing: usize,
    /// The differing pixels without any road in the drawing that is compared.
    pub(crate) missing: usize,
}

impl PixelAgreement {
    pub(crate) fn share(&self) -> f64 {
        self.differing as f64 / self.of_roads.max(1) as f64
    }
}

/// An endless sequence of views, the same for the same places and seed.
pub(crate) struct Views {
    places: Vec<RoadPlace>,
    random: Random,
}

impl Views {
    pub(crate) fn new(places: Vec<RoadPlace>, seed: u64) -> Self {
        assert!(!places.is_empty(), "a package without roads");
        Self { places, random: Random::new(seed) }
    }

    pub(crate) fn next_view(&mut self) -> View {
        let index = (self.random.share() * self.places.len() as f64) as usize;
        let place = self.places[index];
        let distance_m = 300.0 * 100.0_f64.powf(self.random.share());
        let heading_deg = 360.0 * self.random.share();
        let pitch_deg = 85.0 * self.random.share();
        View { place, distance_m, orientation: Orientation { heading_deg, pitch_deg } }
    }
}
