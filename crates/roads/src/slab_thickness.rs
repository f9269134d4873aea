//! How thick the slab of a bridge is shown, in pictures and models alike.

use crate::road::FunctionalRoadClass;

/// How thick the slab under a bridge of a class is, true metres. A tile does not know how long a bridge is that goes on in others, so its class alone tells.
#[must_use]
pub fn slab_thickness_m(class: FunctionalRoadClass) -> f64 {
    match class.number() {
        0..=3 => 1.5,
        4..=6 => 1.0,
        _ => 0.5,
    }
}
