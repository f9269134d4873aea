//! The displayed thickness of a bridge's slab, in images and models alike.

use crate::road::FunctionalRoadClass;

/// Returns the thickness of the slab under a bridge of a class, true metres. It depends on the
/// class alone, because a tile does not know the length of a bridge that continues in other tiles.
#[must_use]
pub fn slab_thickness_m(class: FunctionalRoadClass) -> f64 {
    match class.number() {
        0..=3 => 1.5,
        4..=6 => 1.0,
        _ => 0.5,
    }
}
