//! All photos of a build, placed on the grid of a package.

use corniche_geom::Bounds;

use crate::TexelGrid;
use crate::photo_file::PlacedPhoto;

/// Photos on a package's grid. May be shared between threads.
#[derive(Debug, Clone)]
pub struct PhotoGrid {
    pub(crate) photos: Vec<PlacedPhoto>,
    pub(crate) texels: TexelGrid,
}

impl PhotoGrid {
    /// The texels of the finest level.
    #[must_use]
    pub fn texels(&self) -> &TexelGrid {
        &self.texels
    }

    /// Whether a photo may lie in a rectangle, working metres.
    #[must_use]
    pub fn touches(&self, bounds: &Bounds) -> bool {
        self.photos.iter().any(|photo| overlap(&photo.bounds, bounds))
    }

    /// Area of the rectangles around the photos, square metres of the grid; where they overlap it counts twice.
    #[must_use]
    pub fn area_m2(&self) -> f64 {
        self.photos.iter().map(|photo| photo.bounds.width() * photo.bounds.height()).sum()
    }
}

pub(crate) fn overlap(a: &Bounds, b: &Bounds) -> bool {
    a.min_x < b.max_x && b.min_x < a.max_x && a.min_y < b.max_y && b.min_y < a.max_y
}
