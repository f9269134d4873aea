//! The working CRS of a package: a CRS whose coordinates become working metres.

use corniche_geom::{Bounds, Seam};

use crate::crs::horizontal::Crs;

/// A CRS with the factors that make its coordinates working metres.
///
/// Working x = first coordinate × `metres_per_unit[0]`, y likewise. No PROJ method is invented for it: `eqc` is
/// spherical in some versions of PROJ and ellipsoidal in others.
#[derive(Debug, Clone)]
pub(crate) struct Working {
    pub(crate) crs: Crs,
    /// East and north; negative for an axis that counts westwards or southwards.
    pub(crate) metres_per_unit: [f64; 2],
    /// First coordinate in the middle of the data: where it comes back after a turn, images are those nearest to it, beyond ±180° too.
    pub(crate) middle: f64,
    /// Whether the factors make lengths true at the standard latitude. False where the factors are the unit of the
    /// CRS alone.
    pub(crate) is_scaled: bool,
}

impl Working {
    /// The same around the middle of data in working metres.
    pub(crate) fn around(self, data_m: Bounds) -> Self {
        Self { middle: data_m.center()[0] / self.metres_per_unit[0], ..self }
    }

    /// The seam of the CRS around the middle of the data, in its own coordinates; `None` where x never comes back.
    pub(crate) fn seam(&self) -> Option<Seam> {
        self.crs.turn.map(|turn| Seam::new(self.middle, turn))
    }

    /// The same in working metres.
    pub(crate) fn seam_m(&self) -> Option<Seam> {
        let metres = self.metres_per_unit[0];
        self.crs.turn.map(|turn| Seam::new(self.middle * metres, turn * metres))
    }
}
