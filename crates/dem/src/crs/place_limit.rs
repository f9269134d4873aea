//! Which coordinates PROJ may get: no place has larger ones, and with some it never ends.

use crate::crs::horizontal::Crs;

/// Turns around the earth that an angle may count. PROJ takes off one after the other, so that 10¹⁷ degrees keep it busy for ever. Data go on
/// for one turn beyond ±180 degrees, and packages name no longitude beyond 720.
const MOST_TURNS: f64 = 4.0;
/// Metres that a projected coordinate may count: as many as working metres.
const MOST_METRES: f64 = corniche_geom::MAX_COORDINATE_M;

/// The largest coordinates of a system that go to PROJ.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlaceLimit {
    most: f64,
}

impl PlaceLimit {
    /// The limit of a system.
    pub(crate) fn of_crs(crs: &Crs) -> Self {
        let most = crs.turn_angle().map_or(MOST_METRES / crs.unit_m, |turn| MOST_TURNS * turn);
        Self { most }
    }

    /// A position as PROJ may get it: infinite where it is no place, so that it has no image.
    pub(crate) fn limited(self, position: [f64; 2]) -> [f64; 2] {
        let is_place = position.iter().all(|value| value.abs() <= self.most);
        if is_place { position } else { [f64::INFINITY; 2] }
    }
}
