//! The working CRS of a package: a CRS whose coordinates become working metres.

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
    /// First coordinate in the middle of the data: longitudes are the images nearest to it, beyond ±180° too.
    pub(crate) middle: f64,
    /// Whether the factors make lengths true at the standard latitude. False where the factors are the unit of the
    /// CRS alone.
    pub(crate) is_scaled: bool,
}
